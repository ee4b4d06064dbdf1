/// The judgement of a finished scene on the true meshes; no solver and no proxy has a say in it.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <vector>

namespace bin_scenes {

/// Overlap of two placed meshes.
struct Penetration {
  double depth = 0.0;            ///< m: how far they must move apart where they overlap (0 = apart)
  Vec3 direction = Vec3::Zero(); ///< unit, moves b away from a
  Vec3 point = Vec3::Zero();     ///< bin frame
};
Penetration penetration(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b);

/// Of a placed mesh into walls and floor of the bin (depth only counts below the rim).
Penetration bin_penetration(const MeshQuery& part, const Pose& pose, const Bin& bin, const MeshQuery* bin_mesh);

/// Shortest distance between two placed meshes (0 if they touch or overlap), up to `limit`.
double clearance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, double limit);

/// Fills report.penetration, report.gap, and accepted / reasons of the scene from its poses and flags.
/// `parts[scene.parts[i].line]` is the model of part i; `bin_model` only for a mesh bin.
void judge(Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
           const PartModelPtr& bin_model = nullptr);

/// Drift of the poses `before` -> `after` of the same scene (centres of mass, turn): fills report.drift.
DriftReport drift(const Scene& before, const Scene& after, const std::vector<PartModelPtr>& parts);

}  // namespace bin_scenes
