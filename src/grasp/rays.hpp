/// The points where a ray passes through the surface of a mesh. Searches for grasps use them to find opposite sides of
/// a part, and removal.hpp uses them to find what is above it.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <vector>

namespace bin_scenes {

struct Passage {
  double distance;       ///< m along the ray, whose direction has unit length
  std::size_t triangle;  ///< index of the triangle in the mesh
};

/// Returns all points where the ray crosses the surface at more than `from` (m) from its origin, ordered by distance.
std::vector<Passage> passages(const MeshQuery& mesh, const Vec3& origin, const Vec3& direction, double from);

}  // namespace bin_scenes
