/// Walks the open edges into loops and closes small loops: of few vertices by the triangulation of least area, others
/// by a fan.
#include "holes.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "edge_uses.hpp"
#include "shells.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace bin_scenes::repair {

std::vector<std::vector<std::uint32_t>> boundary_loops(const Mesh& mesh) {
  // Missing passages by start vertex. As many start at a vertex as end there, so every walk closes.
  std::map<std::uint32_t, std::vector<std::uint32_t>> next;
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    const int missing = -surplus(first, last);
    for (int i = 0; i < std::abs(missing); ++i) {
      if (missing > 0) next[first->low].push_back(first->high);
      if (missing < 0) next[first->high].push_back(first->low);
    }
  });
  std::vector<std::vector<std::uint32_t>> loops;
  std::map<std::uint32_t, std::size_t> place;  // in the walk
  for (auto& [seed, ends] : next) {
    while (!ends.empty()) {
      std::vector<std::uint32_t> walk{seed};
      place = {{seed, 0}};
      while (!walk.empty()) {
        std::vector<std::uint32_t>& onward = next[walk.back()];
        if (onward.empty()) break;
        const std::uint32_t v = onward.back();
        onward.pop_back();
        const auto [seen, is_new] = place.try_emplace(v, walk.size());
        if (is_new) {
          walk.push_back(v);
          continue;
        }
        // Back at a vertex of the walk: cut off the loop since then, so that loops that touch do not become one.
        const std::size_t begin = seen->second;
        loops.emplace_back(walk.begin() + static_cast<std::ptrdiff_t>(begin), walk.end());
        for (std::size_t i = begin + 1; i < walk.size(); ++i) place.erase(walk[i]);
        walk.resize(begin + 1);
        if (begin == 0) break;
      }
    }
  }
  return loops;
}

double perimeter(const Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  BIN_SCENES_ASSERT(each_is(loop, [&](std::uint32_t v) { return v < mesh.vertices.size(); }));
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    length += (mesh.vertices[loop[(i + 1) % loop.size()]] - mesh.vertices[loop[i]]).norm();
  }
  return length;
}

namespace {

void fill_with_least_area(Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  const std::size_t n = loop.size();
  BIN_SCENES_ASSERT(n >= 2);
  const std::size_t before = mesh.triangles.size();
  std::vector<double> least(n * n, 0.0);
  std::vector<std::uint32_t> apex(n * n, 0);
  const auto at = [&](std::size_t i) { return mesh.vertices[loop[i]]; };
  for (std::size_t span = 2; span < n; ++span) {
    stop_if_cancelled();
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t k = i + span;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t m = i + 1; m < k; ++m) {
        const double cost = least[i * n + m] + least[m * n + k] + (at(m) - at(i)).cross(at(k) - at(i)).norm();
        if (cost < best) {
          best = cost;
          apex[i * n + k] = static_cast<std::uint32_t>(m);
        }
      }
      least[i * n + k] = best;
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> chords{{0, n - 1}};
  while (!chords.empty()) {
    const auto [i, k] = chords.back();
    chords.pop_back();
    if (k - i < 2) continue;
    const std::size_t m = apex[i * n + k];
    mesh.triangles.push_back({loop[i], loop[m], loop[k]});
    chords.push_back({i, m});
    chords.push_back({m, k});
  }
  BIN_SCENES_ASSERT(mesh.triangles.size() == before + n - 2);
}

void fill_with_fan(Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  Vec3 mid = Vec3::Zero();
  for (const std::uint32_t v : loop) mid += mesh.vertices[v];
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(mid / static_cast<double>(loop.size()));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    mesh.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], center});
  }
}

}  // namespace

Closed close_holes(Mesh& mesh, double max_perimeter) {
  constexpr std::size_t longest_for_least_area = 600;  // a second or so
  std::size_t looks = 30'000'000;  // from covers at triangles, a second or so: a soup of triangles stays as it is
  const auto loops = boundary_loops(mesh);
  Closed closed;
  if (loops.empty()) return closed;
  const Shells labels = shells(mesh);
  std::map<std::uint32_t, std::uint32_t> shell_of;  // of the vertices of loops
  for (const auto& loop : loops) {
    for (const std::uint32_t v : loop) shell_of[v] = 0;
  }
  for (std::size_t t = 0; t < labels.of_triangle.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      const auto found = shell_of.find(v);
      if (found != shell_of.end()) found->second = labels.of_triangle[t];
    }
  }
  for (const auto& loop : loops) {
    const bool small = perimeter(mesh, loop) <= max_perimeter;
    if (!small && looks < labels.of_triangle.size()) continue;
    const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
    loop.size() <= longest_for_least_area ? fill_with_least_area(mesh, loop) : fill_with_fan(mesh, loop);
    if (small) {
      ++closed.small;
      continue;
    }
    std::vector<std::uint32_t> others;
    for (std::uint32_t t = 0; t < labels.of_triangle.size(); ++t) {
      if (labels.of_triangle[t] != shell_of[loop[0]]) others.push_back(t);
    }
    const bool hidden = std::all_of(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangles),
                                    mesh.triangles.end(), [&](const Triangle& t) {
                                      looks -= std::min(looks, others.size());
                                      const Vec3 sum = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
                                      return winding(mesh, others, sum / 3.0) > 0.5;
                                    });
    if (hidden) {
      ++closed.hidden;
    } else {
      mesh.vertices.resize(vertices);
      mesh.triangles.resize(triangles);
    }
  }
  BIN_SCENES_ASSERT(indices_in_range(mesh) && closed.small + closed.hidden <= loops.size());
  return closed;
}

}  // namespace bin_scenes::repair
