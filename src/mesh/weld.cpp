/// Vertices within a tolerance become one, by a grid. Triangles that lose a corner by it, slivers and copies are taken
/// out without opening gaps.
#include "weld.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace bin_scenes::repair {

namespace {

/// Longest side of a triangle, as the corner it starts from, and the height over it.
struct Shape {
  int longest;
  double height;
};
Shape shape(const Mesh& mesh, const Triangle& t) {
  std::array<double, 3> length2;
  for (int k = 0; k < 3; ++k) {
    length2[k] = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm();
  }
  const int longest = static_cast<int>(std::max_element(length2.begin(), length2.end()) - length2.begin());
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double base = std::sqrt(length2[longest]);
  return {longest, base > 0.0 ? (b - a).cross(c - a).norm() / base : 0.0};
}

template <class Predicate>
std::size_t remove_triangles(Mesh& mesh, Predicate&& unwanted) {
  const auto end = std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), unwanted);
  const auto removed = static_cast<std::size_t>(mesh.triangles.end() - end);
  mesh.triangles.erase(end, mesh.triangles.end());
  return removed;
}

struct CellHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& c) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    for (const std::int64_t x : c) h = (h ^ static_cast<std::uint64_t>(x)) * 0xbf58476d1ce4e5b9ULL, h ^= h >> 29;
    return h;
  }
};

/// For each vertex the first vertex within `tolerance` that stands for itself.
std::vector<std::uint32_t> representatives(const std::vector<Vec3>& vertices, double tolerance, double diagonal) {
  // Cells a few tolerances wide: most vertices look into one cell only. The map is only looked up by key; its order
  // decides nothing.
  const double cell = std::max(4.0 * tolerance, 1e-12 * diagonal);
  std::unordered_map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>, CellHash> cells;
  cells.reserve(vertices.size());
  Aabb box;
  for (const Vec3& v : vertices) box.extend(v);
  std::vector<std::uint32_t> standing(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const auto index = [&](double x, int axis) {
      return static_cast<std::int64_t>(std::floor((x - box.lower[axis]) / cell));
    };
    std::array<std::int64_t, 3> lower, upper, c;
    for (int k = 0; k < 3; ++k) {
      lower[k] = index(vertices[i][k] - tolerance, k);
      upper[k] = index(vertices[i][k] + tolerance, k);
    }
    standing[i] = i;
    for (c[0] = lower[0]; c[0] <= upper[0]; ++c[0]) {
      for (c[1] = lower[1]; c[1] <= upper[1]; ++c[1]) {
        for (c[2] = lower[2]; c[2] <= upper[2]; ++c[2]) {
          const auto found = cells.find(c);
          if (found == cells.end()) continue;
          for (const std::uint32_t j : found->second) {
            if (j < standing[i] && (vertices[j] - vertices[i]).squaredNorm() <= tolerance * tolerance) standing[i] = j;
          }
        }
      }
    }
    if (standing[i] == i)
      cells[{index(vertices[i][0], 0), index(vertices[i][1], 1), index(vertices[i][2], 2)}].push_back(i);
  }
  // A vertex that stands for others stands for itself.
  BIN_SCENES_ASSERT(each_is(standing, [&](std::uint32_t s) { return standing[s] == s; }));
  return standing;
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> used(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = 1;
  }
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    mesh.vertices[next] = mesh.vertices[i];
    used[i] = next++;
  }
  mesh.vertices.resize(next);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = used[v];
  }
}

}  // namespace

Welded weld(Mesh& mesh, double tolerance) {
  BIN_SCENES_ASSERT(tolerance >= 0.0 && indices_in_range(mesh));
  Welded result;
  const std::vector<std::uint32_t> standing = representatives(mesh.vertices, tolerance, mesh.bounds().diagonal());
  for (std::uint32_t i = 0; i < standing.size(); ++i) result.vertices += standing[i] != i;
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = standing[v];
  }
  result.triangles =
      remove_triangles(mesh, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  drop_unused_vertices(mesh);
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  return result;
}

std::size_t remove_slivers(Mesh& mesh, double tolerance) {
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  return remove_triangles(mesh, [&](const Triangle& t) { return shape(mesh, t).height <= tolerance; });
}

Duplicates remove_duplicates(Mesh& mesh, bool keep_one_side) {
  struct Key {
    Triangle sorted;
    bool even;
    std::uint32_t triangle;
  };
  std::vector<Key> keys;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle v = mesh.triangles[t];
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    const bool even = v[1] < v[2];
    if (!even) std::swap(v[1], v[2]);
    keys.push_back({v, even, t});
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& a, const Key& b) { return std::tie(a.sorted, a.triangle) < std::tie(b.sorted, b.triangle); });
  BIN_SCENES_ASSERT(
      std::is_sorted(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.sorted < b.sorted; }));
  Duplicates result;
  std::vector<char> keep(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < keys.size();) {
    std::size_t j = i, even = 0;
    for (; j < keys.size() && keys[j].sorted == keys[i].sorted; ++j) even += keys[j].even;
    const std::size_t odd = j - i - even, pairs = std::min(even, odd);
    result.opposite_pairs += pairs;
    const bool one_remains = even != odd || keep_one_side;
    if (even != odd) result.same += j - i - 2 * pairs - 1;
    if (one_remains) {
      const bool side = even == odd ? keys[i].even : even > odd;
      for (std::size_t k = i; k < j; ++k) {
        if (keys[k].even != side) continue;
        keep[keys[k].triangle] = 1;
        break;
      }
    }
    i = j;
  }
  std::size_t next = 0;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (keep[t]) mesh.triangles[next++] = mesh.triangles[t];
  }
  BIN_SCENES_ASSERT(next + result.same + 2 * result.opposite_pairs >= mesh.triangles.size());
  mesh.triangles.resize(next);
  return result;
}

}  // namespace bin_scenes::repair
