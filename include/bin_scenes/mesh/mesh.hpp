/// A triangle mesh in metres, in the frame of the model file.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

using Triangle = std::array<std::uint32_t, 3>;  ///< vertex indices, counter-clockwise seen from outside

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  Aabb bounds() const;
  /// Outward normal times twice the area of triangle t.
  Vec3 area_vector(std::size_t t) const;
  bool empty() const { return triangles.empty(); }
};

/// Whether all corners of triangles are vertices.
bool indices_in_range(const Mesh& mesh);

/// The same mesh moved by a pose.
Mesh transformed(const Mesh& mesh, const Pose& pose);

}  // namespace bin_scenes
