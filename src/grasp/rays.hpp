/// All places where a line passes through the surface of a mesh.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <vector>

namespace bin_scenes {

struct Passage {
  double distance;       ///< along the direction, which has unit length
  std::size_t triangle;  ///< of the mesh
};

/// Ordered by distance, those ahead of the origin by more than `from`.
std::vector<Passage> passages(const MeshQuery& mesh, const Vec3& origin, const Vec3& direction, double from);

}  // namespace bin_scenes
