#include "thicken.hpp"

#include "holes.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <vector>

namespace bin_scenes::repair {

void thicken(Mesh& mesh, double thickness) {
  BIN_SCENES_ASSERT(thickness > 0.0 && indices_in_range(mesh));
  const std::size_t count = mesh.vertices.size();
  std::vector<Vec3> normal(count, Vec3::Zero());
  std::vector<double> total(count, 0.0), towards(count, 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) normal[v] += mesh.area_vector(t);
  }
  for (Vec3& n : normal) n = n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.area_vector(t);
    for (const std::uint32_t v : mesh.triangles[t]) {
      total[v] += a.norm();
      towards[v] += a.dot(normal[v]);
    }
  }
  BIN_SCENES_ASSERT(each_is(normal, [](const Vec3& n) { return is_unit(n); }));
  const auto loops = boundary_loops(mesh);
  const std::vector<Triangle> sheet = mesh.triangles;
  mesh.vertices.resize(2 * count);
  for (std::size_t v = 0; v < count; ++v) {
    // Mean cosine between the faces around and the displacement of the vertex: the face moves by it per unit of that.
    const double cosine = total[v] > 0.0 ? std::max(0.5, towards[v] / total[v]) : 1.0;
    const Vec3 offset = 0.5 * thickness / cosine * normal[v];
    mesh.vertices[count + v] = mesh.vertices[v] - offset;
    mesh.vertices[v] += offset;
  }
  const auto below = static_cast<std::uint32_t>(count);
  for (const auto& [a, b, c] : sheet) mesh.triangles.push_back({a + below, c + below, b + below});
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      mesh.triangles.push_back({a, b, b + below});
      mesh.triangles.push_back({a, b + below, a + below});
    }
  }
}

}  // namespace bin_scenes::repair
