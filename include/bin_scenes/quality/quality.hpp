/// The judgement of a finished scene on the true meshes; no solver and no proxy has a say in it.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <vector>

namespace bin_scenes {

/// Overlap of two placed closed meshes, concave allowed. The depth is that of the deepest pair of convex pieces that
/// touch: for convex meshes the exact length of the shortest translation that parts them, for concave ones the largest
/// of the local ones, never more than a translation that clears the overlap (src/quality/penetration.cpp). One mesh
/// inside the other overlaps as well. Touching is 0.
struct Penetration {
  double depth = 0.0;             ///< m: how far they must move apart where they overlap (0 = apart)
  Vec3 direction = Vec3::Zero();  ///< unit, moves b away from a
  Vec3 point = Vec3::Zero();      ///< bin frame
};
Penetration penetration(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b);

/// Of a placed mesh into walls and floor of the bin (a wall is solid outwards without end, up to the rim; the way out
/// is back into the bin or up over the rim, whichever is shorter). A mesh bin is judged like a part if it is closed; an
/// open one is a sheet, solid on the side away from the part.
Penetration bin_penetration(const MeshQuery& part, const Pose& pose, const Bin& bin, const MeshQuery* bin_mesh);

/// Shortest distance between two placed meshes (0 if they touch or overlap), up to `limit`.
double clearance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, double limit);

/// How far a can move along `direction` (unit, bin frame) before it touches b, up to `limit`. 0 where their surfaces
/// cut each other along the way already.
double free_way(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, const Vec3& direction,
                double limit);

/// Fills report.penetration, report.gap, and accepted / reasons of the scene from its poses and flags.
/// `parts[scene.parts[i].line]` is the model of part i; `bin_model` only for a mesh bin.
///
/// Penetration: of all pairs with a movable part; overlap below 1e-6 of the smaller diagonal is rounding and not
/// counted; escaped parts count against each other, not against the bin.
/// Gap: of every resting part the free way along gravity before it touches another part or the bin. What it overlaps
/// already holds it only if the shortest way out of it leads up, or if it is in the way from the nearest place where the
/// two do not overlap. Parts with nothing at all below them are left out, and so is everything without gravity.
/// Accepted, unless a pair or a part and the bin overlap by more than accept.penetration, a part at rest could fall by
/// more than accept.gap, a part gained more energy from nowhere than accept.energy (report.energy, which pour fills in),
/// parts escaped (and accept.escaped is not set), none of the parts that should have been poured
/// was, or the scene is not at rest (and no exact time was asked for).
void judge(Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
           const PartModelPtr& bin_model = nullptr);

/// Drift of the poses `before` -> `after` of the same scene (centres of mass, turn): fills report.drift.
DriftReport drift(const Scene& before, const Scene& after, const std::vector<PartModelPtr>& parts);

}  // namespace bin_scenes
