/// The exact distance between placed meshes, which tests and benchmarks ask for.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

namespace bin_scenes::test {

/// Shortest distance between two placed meshes (0 if they touch or overlap), up to `limit`.
double clearance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, double limit);

}  // namespace bin_scenes::test
