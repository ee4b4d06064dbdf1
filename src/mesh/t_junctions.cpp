#include "t_junctions.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "edge_uses.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace bin_scenes::repair {

std::size_t split_t_junctions(Mesh& mesh, double tolerance) {
  std::size_t inserted = 0;
  std::size_t looks = 40'000'000;  // at vertices, half a second: a soup of triangles stays as it is
  // Each pass splits a triangle along one of its edges; the pieces' other edges get their turn in the next pass.
  // Splitting adds no vertices, so the passes end; the bound only guards against rounding.
  for (int pass = 0; pass < 100; ++pass) {
    const std::vector<EdgeUse> uses = edge_uses(mesh);
    std::vector<EdgeUse> open;
    std::vector<std::uint32_t> rim;  // vertices of open edges
    for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
      if (last - first != 1) return;
      open.push_back(*first);
      rim.push_back(first->low);
      rim.push_back(first->high);
    });
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    std::sort(rim.begin(), rim.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::make_pair(mesh.vertices[a].x(), a) < std::make_pair(mesh.vertices[b].x(), b);
    });

    std::vector<char> split(mesh.triangles.size(), 0);
    std::size_t inserted_now = 0;
    for (const EdgeUse& edge : open) {
      stop_if_cancelled();
      if (split[edge.triangle]) continue;
      const Triangle t = mesh.triangles[edge.triangle];
      const std::uint32_t a = t[edge.corner], b = t[(edge.corner + 1) % 3], c = t[(edge.corner + 2) % 3];
      const Vec3 start = mesh.vertices[a], along = mesh.vertices[b] - start;
      const double length = along.norm();
      if (length <= 2.0 * tolerance) continue;
      const double lower = std::min(start.x(), mesh.vertices[b].x()) - tolerance;
      const double upper = std::max(start.x(), mesh.vertices[b].x()) + tolerance;
      auto candidate = std::lower_bound(rim.begin(), rim.end(), lower,
                                        [&](std::uint32_t v, double x) { return mesh.vertices[v].x() < x; });
      std::vector<std::pair<double, std::uint32_t>> on_edge;
      for (; looks > 0 && candidate != rim.end() && mesh.vertices[*candidate].x() <= upper; ++candidate, --looks) {
        if (*candidate == a || *candidate == b || *candidate == c) continue;
        const Vec3 to = mesh.vertices[*candidate] - start;
        const double place = to.dot(along) / length;
        if (place <= tolerance || place >= length - tolerance) continue;
        if ((to - place / length * along).norm() <= tolerance) on_edge.push_back({place, *candidate});
      }
      if (on_edge.empty()) continue;
      std::sort(on_edge.begin(), on_edge.end());
      BIN_SCENES_ASSERT(on_edge.front().first > 0.0 && on_edge.back().first < length);
      std::uint32_t previous = a;
      for (const auto& [place, v] : on_edge) {
        mesh.triangles.push_back({previous, v, c});
        previous = v;
      }
      mesh.triangles[edge.triangle] = {previous, b, c};
      split[edge.triangle] = 1;
      inserted_now += on_edge.size();
    }
    if (inserted_now == 0) break;
    inserted += inserted_now;
  }
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  return inserted;
}

}  // namespace bin_scenes::repair
