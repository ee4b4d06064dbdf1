/// A triangle mesh in metres, in the frame of the model file. It is plain data without connectivity; mesh_loader.hpp
/// makes closed meshes from files, and part/ answers queries about them.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

using Triangle = std::array<std::uint32_t, 3>;  ///< vertex indices, counter-clockwise seen from outside

/// Vertices, and triangles that refer to them by index.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  /// Returns the bounding box of all vertices.
  Aabb bounds() const;
  /// Returns the outward normal of triangle t, whose length is twice the triangle's area (m2).
  Vec3 area_vector(std::size_t t) const;
  bool empty() const { return triangles.empty(); }
};

/// Whether every index of a triangle refers to a vertex.
bool indices_in_range(const Mesh& mesh);

/// Returns the mesh with every vertex transformed by a pose.
Mesh transformed(const Mesh& mesh, const Pose& pose);

}  // namespace bin_scenes
