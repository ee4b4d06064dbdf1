#include "bin_scenes/mesh/mesh.hpp"

namespace bin_scenes {

Aabb Mesh::bounds() const {
  Aabb box;
  for (const Vec3& v : vertices) box.extend(v);
  return box;
}

Vec3 Mesh::area_vector(std::size_t t) const {
  const auto& [a, b, c] = triangles[t];
  return (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
}

Mesh transformed(const Mesh& mesh, const Pose& pose) {
  Mesh moved = mesh;
  for (Vec3& v : moved.vertices) v = pose * v;
  return moved;
}

}  // namespace bin_scenes
