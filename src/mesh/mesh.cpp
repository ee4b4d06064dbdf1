#include "bin_scenes/mesh/mesh.hpp"

#include "bin_scenes/core/assertion.hpp"

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

bool indices_in_range(const Mesh& mesh) {
  return each_is(mesh.triangles, [&](const Triangle& t) {
    return each_is(t, [&](std::uint32_t v) { return v < mesh.vertices.size(); });
  });
}

Mesh transformed(const Mesh& mesh, const Pose& pose) {
  BIN_SCENES_ASSERT(is_unit(pose.orientation));
  Mesh moved = mesh;
  for (Vec3& v : moved.vertices) v = pose * v;
  return moved;
}

}  // namespace bin_scenes
