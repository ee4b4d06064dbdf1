/// Judgement of a finished scene on the true meshes: overlap, gap, drift and acceptance. It is independent of solvers
/// and their collision shapes, so that the same measure applies to all of them and to scenes of other programs.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <vector>

namespace bin_scenes {

/// The overlap of two placed closed meshes, which may be concave. The depth is that of the deepest pair of convex
/// pieces that touch. For convex meshes, it is the exact length of the shortest translation that separates them. For
/// concave meshes, it is the largest such length over the touching pieces, which is at most the translation that
/// removes the whole overlap (src/quality/penetration.cpp). A mesh inside the other one overlaps it. The depth of
/// touching meshes is 0.
struct Penetration {
  double depth = 0.0;             ///< depth of the overlap (m); 0: the meshes do not overlap
  Vec3 direction = Vec3::Zero();  ///< unit vector, along which b is moved away from a
  Vec3 point = Vec3::Zero();      ///< a point of the overlap, bin frame (m)
};
Penetration penetration(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b);

/// Returns the overlap of a placed mesh with the walls and the floor of the bin. A wall extends outwards without end
/// and upwards to the rim; the depth is measured back into the bin or up over the rim, whichever is shorter. A closed
/// mesh bin is treated as a part, an open one as a sheet whose side away from the part is solid.
Penetration bin_penetration(const MeshQuery& part, const Pose& pose, const Bin& bin, const MeshQuery* bin_mesh);

/// Returns the distance (m) that a can move along `direction` (unit vector, bin frame) before it touches b, at most
/// `limit`. It is 0 if their surfaces already intersect on that path. `guide` does not affect the result, but makes the
/// search faster if most of a is farther along it than b: it is the normal of a plane that nearly separates them. Its
/// angle to `direction` must be at most 90 degrees; a zero vector means that there is no guide.
double free_distance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b,
                     const Vec3& direction, double limit, const Vec3& guide = Vec3::Zero());

/// Fills report.penetration, report.gap, accepted and reasons of the scene from its poses and flags.
///
/// Penetration is measured for all pairs with a movable part. Overlap below 1e-6 of the smaller diagonal is rounding
/// and does not count. Of escaped parts, only the overlap with each other is measured.
///
/// The gap of a part at rest is the distance that it could fall along gravity before it touches another part or the
/// bin. A neighbour that the part overlaps counts as a support only if the shortest translation out of it points
/// upwards, or if it blocks the fall from the nearest position without overlap. Parts with nothing below them are
/// omitted, and without gravity there is no gap.
///
/// A scene is accepted unless a pair, or a part and the bin, overlap by more than accept.penetration; a part at rest
/// could fall by more than accept.gap; a part gained more unexplained energy than accept.energy (report.energy, which
/// pour fills in); parts escaped and accept.escaped is not set; no part was poured; or the scene is not at rest
/// although no exact time was requested.
void judge(Scene& scene, const LoadedRequest& loaded);

/// The same measures for one part that is in the scene.
struct PartQuality {
  int id = 0;
  double overlap = 0.0;           ///< m: deepest overlap with another part
  double overlap_relative = 0.0;  ///< the largest overlap with another part / smaller diagonal of the pair
  double into_bin = 0.0;          ///< overlap with the bin (m)
  double gap = 0.0;  ///< m: distance of free fall; infinite if nothing is below the part or if it is not at rest
};
/// Returns the measures of all parts that are in the scene, in their order.
std::vector<PartQuality> part_quality(const Scene& scene, const LoadedRequest& loaded);

/// Returns the drift between the poses `before` and `after` of the same scene: displacements of the centres of mass,
/// and rotations. It is the value of report.drift.
DriftReport drift(const Scene& before, const Scene& after, const std::vector<PartModelPtr>& parts);

}  // namespace bin_scenes
