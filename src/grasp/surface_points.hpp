/// Points spread evenly over a surface, always the same.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct SpreadPoint {
  Vec3 point, normal;  ///< of its triangle, outward
};

/// By area, whatever the triangles are like. A low-discrepancy sequence says where in its triangle a point lies.
std::vector<SpreadPoint> spread_points(const Mesh& mesh, std::size_t count);

}  // namespace bin_scenes
