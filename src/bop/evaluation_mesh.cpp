#include "bop/evaluation_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace bin_scenes {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Halves every edge longer than `longest`, once. An edge is halved in both of its triangles: no cracks appear.
bool halve_edges(Mesh& mesh, double longest) {
  std::map<Edge, std::uint32_t> middles;
  const auto center = [&](std::uint32_t a, std::uint32_t b) -> std::uint32_t {
    if ((mesh.vertices[a] - mesh.vertices[b]).norm() <= longest) return a;  // none
    const auto [known, is_new] = middles.emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return known->second;
  };
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> m = {center(t[0], t[1]), center(t[1], t[2]), center(t[2], t[0])};
    const std::array<bool, 3> cut = {m[0] != t[0], m[1] != t[1], m[2] != t[2]};
    const auto count = std::count(cut.begin(), cut.end(), true);
    if (count == 0) {
      triangles.push_back(t);
    } else if (count == 3) {
      triangles.insert(triangles.end(),
                       {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}});
    } else {
      // Turned so that the first edge is cut and, of two that are, the next one, too.
      std::size_t i = 0;
      while (!(cut[i] && (count == 1 || cut[(i + 1) % 3]))) ++i;
      const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], ab = m[i], bc = m[(i + 1) % 3];
      triangles.push_back({ab, b, count == 1 ? c : bc});
      triangles.push_back({a, ab, c});
      if (count == 2) triangles.push_back({ab, bc, c});
    }
  }
  mesh.triangles = std::move(triangles);
  return !middles.empty();
}

}  // namespace

Mesh evaluation_mesh(const Mesh& mesh) {
  const double diagonal = mesh.bounds().size().norm();
  // From a point to a vertex of its triangle: an edge / sqrt(3) at most. From there to the vertex of its cell: sqrt(3).
  const double cell = evaluation_spacing * diagonal / (std::sqrt(3.0) + 1.0 / std::sqrt(3.0));
  Mesh fine = mesh;
  while (halve_edges(fine, cell)) {
  }
  std::map<std::array<long, 3>, std::uint32_t> kept;  // by cell
  std::vector<std::uint32_t> target;
  Mesh coarse;
  for (const Vec3& vertex : fine.vertices) {
    const Vec3 place = (vertex - mesh.bounds().lower) / cell;
    const auto [known, is_new] =
        kept.emplace(std::array<long, 3>{std::lround(place.x()), std::lround(place.y()), std::lround(place.z())},
                     static_cast<std::uint32_t>(coarse.vertices.size()));
    if (is_new) coarse.vertices.push_back(vertex);
    target.push_back(known->second);
  }
  for (const Triangle& t : fine.triangles) {
    const Triangle moved = {target[t[0]], target[t[1]], target[t[2]]};
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) coarse.triangles.push_back(moved);
  }
  return coarse;
}

}  // namespace bin_scenes
