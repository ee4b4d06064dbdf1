#include "shells.hpp"

#include "edge_uses.hpp"

#include "core/disjoint_sets.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <cmath>

namespace bin_scenes::repair {

Shells shells(const Mesh& mesh) {
  DisjointSets triangles(mesh.triangles.size());
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2) triangles.join(first->triangle, first[1].triangle);
  });
  Shells result;
  result.of_triangle.resize(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t r = triangles.root(t);
    result.of_triangle[t] = r == t ? static_cast<std::uint32_t>(result.count++) : result.of_triangle[r];
  }
  BIN_SCENES_ASSERT(each_is(result.of_triangle, [&](std::uint32_t shell) { return shell < result.count; }));
  return result;
}

double signed_volume(const Mesh& mesh) {
  const Vec3 apex = mesh.empty() ? Vec3(Vec3::Zero()) : mesh.bounds().center();
  double volume6 = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume6 += (mesh.vertices[a] - apex).dot((mesh.vertices[b] - apex).cross(mesh.vertices[c] - apex));
  }
  return volume6 / 6.0;
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += 0.5 * mesh.area_vector(t).norm();
  return sum;
}

double winding(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const Vec3& p) {
  BIN_SCENES_ASSERT(p.allFinite());
  double angle = 0.0;
  for (const std::uint32_t t : triangles) {
    const Vec3 a = mesh.vertices[mesh.triangles[t][0]] - p, b = mesh.vertices[mesh.triangles[t][1]] - p,
               c = mesh.vertices[mesh.triangles[t][2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * M_PI);
}

}  // namespace bin_scenes::repair
