/// Points that are spread evenly over a surface. They are the starting points of searches for grasps, and they are the
/// same in each run.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct SpreadPoint {
  Vec3 point, normal;  ///< point on the surface (m), and outward unit normal of its triangle
};

/// Returns `count` points that are distributed by area, independent of the sizes of the triangles; a low-discrepancy
/// sequence gives their positions within triangles. The result depends only on the mesh and on `count`.
std::vector<SpreadPoint> spread_points(const Mesh& mesh, std::size_t count);

}  // namespace bin_scenes
