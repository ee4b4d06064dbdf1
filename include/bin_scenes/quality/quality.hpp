/// Judgement of a finished scene on the true meshes, independent of solvers and their collision shapes.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <vector>

namespace bin_scenes {

/// Overlap of two placed closed meshes, concave allowed. The depth is that of the deepest pair of convex pieces that
/// touch: for convex meshes the exact length of the shortest translation that separates them; for concave ones the
/// largest such length over touching pieces, which is at most the translation that removes the whole overlap
/// (src/quality/penetration.cpp). A mesh inside the other overlaps. Touching is 0.
struct Penetration {
  double depth = 0.0;             ///< m: depth of overlap (0 = none)
  Vec3 direction = Vec3::Zero();  ///< unit, moves b away from a
  Vec3 point = Vec3::Zero();      ///< bin frame
};
Penetration penetration(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b);

/// Overlap of a placed mesh with walls and floor of the bin. A wall extends outwards without end and upwards to the
/// rim; the depth is measured back into the bin or up over the rim, whichever is shorter. A closed mesh bin is treated
/// as a part, an open one as a sheet that is solid on the side away from the part.
Penetration bin_penetration(const MeshQuery& part, const Pose& pose, const Bin& bin, const MeshQuery* bin_mesh);

/// Distance that a can move along `direction` (unit, bin frame) before it touches b, up to `limit`. 0 if their surfaces
/// already intersect on that path.
double free_distance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b,
                     const Vec3& direction, double limit);

/// Fills report.penetration, report.gap, accepted and reasons of the scene from its poses and flags.
///
/// Penetration: of all pairs with a movable part; overlap below 1e-6 of the smaller diagonal is rounding and
/// does not count; escaped parts are measured against each other, not against the bin.
/// Gap: free fall of every resting part along gravity before it touches another part or the bin. A neighbour that it
/// overlaps counts as support only if the shortest translation out of it leads upwards, or if it blocks the fall from
/// the nearest position without overlap. Parts with nothing below them are left out; without gravity there is no gap.
/// Accepted, unless a pair or a part and the bin overlap by more than accept.penetration, a part at rest could fall by
/// more than accept.gap, a part gained more energy from nowhere than accept.energy (report.energy, which pour fills
/// in), parts escaped (and accept.escaped is not set), no part was poured, or the scene is not at rest (and no exact
/// time was asked for).
void judge(Scene& scene, const LoadedRequest& loaded);

/// The same measures for each part that is in the scene, in the order of the scene.
struct PartQuality {
  int id = 0;
  double overlap = 0.0;           ///< m: deepest overlap with another part
  double overlap_relative = 0.0;  ///< the largest one / smaller diagonal
  double into_bin = 0.0;          ///< m: overlap with the bin
  double gap = 0.0;               ///< m: free fall; infinite where nothing lies below, and of parts not at rest
};
std::vector<PartQuality> part_quality(const Scene& scene, const LoadedRequest& loaded);

/// Drift of the poses `before` -> `after` of the same scene (centres of mass, turn): fills report.drift.
DriftReport drift(const Scene& before, const Scene& after, const std::vector<PartModelPtr>& parts);

}  // namespace bin_scenes
