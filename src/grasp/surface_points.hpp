/// Points that are spread evenly over a surface. They are the starting points of searches for grasps, and they are the
/// same in each run.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct SpreadPoint {
  Vec3 point, normal;  ///< the normal of its triangle, outward
};

/// `count` points with equal areas between them, independent of the sizes of the triangles; a low-discrepancy sequence
/// determines their places within triangles. The same mesh gives the same points.
std::vector<SpreadPoint> spread_points(const Mesh& mesh, std::size_t count);

}  // namespace bin_scenes
