#include "mesh_repair.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <unordered_map>

namespace bin_scenes::repair {

namespace {

/// One triangle's passage along an edge; sorted, all passages of an edge lie side by side.
struct EdgeUse {
  std::uint32_t low, high;  // vertices, ascending
  std::uint32_t triangle;
  std::uint8_t corner;  // the edge runs from this corner to the next
  bool forward;         // from low to high
  bool operator<(const EdgeUse& o) const {
    return std::tie(low, high, triangle, corner) < std::tie(o.low, o.high, o.triangle, o.corner);
  }
  bool same_edge(const EdgeUse& o) const { return low == o.low && high == o.high; }
};

std::vector<EdgeUse> edge_uses(const Mesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

/// Calls visit(first, last) for the passages of each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit&& visit) {
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].same_edge(uses[i])) ++j;
    visit(uses.data() + i, uses.data() + j);
    i = j;
  }
}

int surplus(const EdgeUse* first, const EdgeUse* last) {
  int forward = 0;
  for (const EdgeUse* use = first; use != last; ++use) forward += use->forward ? 1 : -1;
  return forward;
}

void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

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
  Welded result;
  const std::vector<std::uint32_t> standing = representatives(mesh.vertices, tolerance, mesh.bounds().diagonal());
  for (std::uint32_t i = 0; i < standing.size(); ++i) result.vertices += standing[i] != i;
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = standing[v];
  }
  result.triangles =
      remove_triangles(mesh, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  drop_unused_vertices(mesh);
  return result;
}

std::size_t remove_slivers(Mesh& mesh, double tolerance) {
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
  mesh.triangles.resize(next);
  return result;
}

std::size_t split_t_junctions(Mesh& mesh, double tolerance) {
  std::size_t inserted = 0;
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
      for (; candidate != rim.end() && mesh.vertices[*candidate].x() <= upper; ++candidate) {
        if (*candidate == a || *candidate == b || *candidate == c) continue;
        const Vec3 to = mesh.vertices[*candidate] - start;
        const double way = to.dot(along) / length;
        if (way <= tolerance || way >= length - tolerance) continue;
        if ((to - way / length * along).norm() <= tolerance) on_edge.push_back({way, *candidate});
      }
      if (on_edge.empty()) continue;
      std::sort(on_edge.begin(), on_edge.end());
      std::uint32_t previous = a;
      for (const auto& [way, v] : on_edge) {
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
  return inserted;
}

Shells shells(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 2) return;
    const std::uint32_t a = root(first->triangle), b = root(first[1].triangle);
    parent[std::max(a, b)] = std::min(a, b);
  });
  Shells result;
  result.of_triangle.resize(parent.size());
  for (std::uint32_t t = 0; t < parent.size(); ++t) {
    const std::uint32_t r = root(t);
    result.of_triangle[t] = r == t ? static_cast<std::uint32_t>(result.count++) : result.of_triangle[r];
  }
  return result;
}

Agreement agree_winding(Mesh& mesh) {
  struct Link {
    std::uint32_t triangle;
    bool agrees;
  };
  std::vector<std::array<Link, 3>> links(mesh.triangles.size());
  std::vector<std::uint8_t> degree(mesh.triangles.size(), 0);
  bool agreed = true;
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 2) return;
    const std::uint32_t a = first->triangle, b = first[1].triangle;
    const bool agrees = first->forward != first[1].forward;
    agreed = agreed && agrees;
    links[a][degree[a]++] = {b, agrees};
    links[b][degree[b]++] = {a, agrees};
  });
  Agreement result;
  if (agreed) return result;
  constexpr char unseen = 0, kept = 1, turned = 2;
  std::vector<char> side(mesh.triangles.size(), unseen);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (side[seed] != unseen) continue;
    std::vector<std::uint32_t> members{seed};
    side[seed] = kept;
    std::size_t to_turn = 0, conflicts = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::uint32_t t = members[i];
      to_turn += side[t] == turned;
      for (std::uint8_t k = 0; k < degree[t]; ++k) {
        const auto [other, agrees] = links[t][k];
        const char opposite = side[t] == kept ? turned : kept, wanted = agrees ? side[t] : opposite;
        if (side[other] == unseen) {
          side[other] = wanted;
          members.push_back(other);
        } else {
          conflicts += side[other] != wanted;
        }
      }
    }
    result.conflicts += conflicts / 2;  // seen from both sides
    const char minority = 2 * to_turn > members.size() ? kept : turned;
    for (const std::uint32_t t : members) {
      if (side[t] != minority) continue;
      turn(mesh.triangles[t]);
      ++result.turned;
    }
  }
  return result;
}

std::size_t open_edges(const Mesh& mesh) {
  std::size_t count = 0;
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    count += static_cast<std::size_t>(std::abs(surplus(first, last)));
  });
  return count;
}

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
        std::vector<std::uint32_t>& ways = next[walk.back()];
        if (ways.empty()) break;
        const std::uint32_t v = ways.back();
        ways.pop_back();
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
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    length += (mesh.vertices[loop[(i + 1) % loop.size()]] - mesh.vertices[loop[i]]).norm();
  }
  return length;
}

namespace {

/// Winding number of some triangles of a mesh about a point.
double winding(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const Vec3& p) {
  double angle = 0.0;
  for (const std::uint32_t t : triangles) {
    const Vec3 a = mesh.vertices[mesh.triangles[t][0]] - p, b = mesh.vertices[mesh.triangles[t][1]] - p,
               c = mesh.vertices[mesh.triangles[t][2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * M_PI);
}

/// Triangulation of least area of a closed loop, by dynamic programming over its chords: O(n^3) time, O(n^2) memory.
void fill_with_least_area(Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  const std::size_t n = loop.size();
  std::vector<double> least(n * n, 0.0);
  std::vector<std::uint32_t> apex(n * n, 0);
  const auto at = [&](std::size_t i) { return mesh.vertices[loop[i]]; };
  for (std::size_t span = 2; span < n; ++span) {
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
}

void fill_with_fan(Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t v : loop) middle += mesh.vertices[v];
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(middle / static_cast<double>(loop.size()));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    mesh.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], center});
  }
}

}  // namespace

Closed close_holes(Mesh& mesh, double max_perimeter) {
  constexpr std::size_t longest_for_least_area = 600;  // a second or so
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
    const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
    loop.size() <= longest_for_least_area ? fill_with_least_area(mesh, loop) : fill_with_fan(mesh, loop);
    if (perimeter(mesh, loop) <= max_perimeter) {
      ++closed.small;
      continue;
    }
    std::vector<std::uint32_t> others;
    for (std::uint32_t t = 0; t < labels.of_triangle.size(); ++t) {
      if (labels.of_triangle[t] != shell_of[loop[0]]) others.push_back(t);
    }
    const bool hidden = std::all_of(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangles),
                                    mesh.triangles.end(), [&](const Triangle& t) {
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
  return closed;
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

std::size_t turn_outward(Mesh& mesh) {
  struct Shell {
    std::vector<std::uint32_t> triangles;
    Aabb box;
    double volume6 = 0.0;
    bool closed = true;
    bool outermost = true;
    bool inside_out() const { return closed && volume6 < 0.0; }
  };
  const Shells labels = shells(mesh);
  std::vector<Shell> list(labels.count);
  const Vec3 apex = mesh.empty() ? Vec3(Vec3::Zero()) : mesh.bounds().center();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Shell& shell = list[labels.of_triangle[t]];
    shell.triangles.push_back(t);
    const Vec3 &a = mesh.vertices[mesh.triangles[t][0]], &b = mesh.vertices[mesh.triangles[t][1]],
               &c = mesh.vertices[mesh.triangles[t][2]];
    for (const Vec3* v : {&a, &b, &c}) shell.box.extend(*v);
    shell.volume6 += (a - apex).dot((b - apex).cross(c - apex));
  }
  // Shells that meet along an edge are closed each by itself, or their volumes mean nothing.
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* use = first; use != last; ++use) {
      const std::uint32_t label = labels.of_triangle[use->triangle];
      int passages = 0;
      for (const EdgeUse* other = first; other != last; ++other) {
        if (labels.of_triangle[other->triangle] == label) passages += other->forward ? 1 : -1;
      }
      if (passages != 0) list[label].closed = false;
    }
  });
  if (std::none_of(list.begin(), list.end(), [](const Shell& shell) { return shell.inside_out(); })) return 0;

  const auto contains = [&](const Shell& outer, const Shell& inner) {
    if ((inner.box.lower.array() < outer.box.lower.array()).any()) return false;
    if ((inner.box.upper.array() > outer.box.upper.array()).any()) return false;
    return std::abs(winding(mesh, outer.triangles, mesh.vertices[mesh.triangles[inner.triangles[0]][0]])) > 0.5;
  };
  std::vector<std::vector<std::size_t>> inside(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t j = 0; j < list.size(); ++j) {
      if (i == j || !contains(list[i], list[j])) continue;
      inside[i].push_back(j);
      list[j].outermost = false;
    }
  }
  std::vector<char> turned(list.size(), 0);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].outermost || !list[i].inside_out()) continue;
    turned[i] = 1;
    for (const std::size_t j : inside[i]) turned[j] = 1;
  }
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!turned[labels.of_triangle[t]]) continue;
    turn(mesh.triangles[t]);
    ++count;
  }
  return count;
}

std::size_t overlapping_pairs(const Mesh& mesh) {
  struct Solid {
    std::vector<std::uint32_t> triangles;
    Aabb box;
    double volume6 = 0.0;
  };
  const Shells labels = shells(mesh);
  if (labels.count < 2) return 0;
  std::vector<Solid> solids(labels.count);
  const Vec3 apex = mesh.bounds().center();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Solid& solid = solids[labels.of_triangle[t]];
    solid.triangles.push_back(t);
    const auto& [a, b, c] = mesh.triangles[t];
    for (const std::uint32_t v : mesh.triangles[t]) solid.box.extend(mesh.vertices[v]);
    solid.volume6 += (mesh.vertices[a] - apex).dot((mesh.vertices[b] - apex).cross(mesh.vertices[c] - apex));
  }
  const auto enters = [&](const Solid& one, const Solid& other) {
    const std::size_t step = std::max<std::size_t>(1, one.triangles.size() / 50);
    for (std::size_t i = 0; i < one.triangles.size(); i += step) {
      const auto& [a, b, c] = mesh.triangles[one.triangles[i]];
      const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      for (const Vec3& probe :
           {Vec3((p + q + r) / 3.0), Vec3((p + q) / 2.0), Vec3((q + r) / 2.0), Vec3((r + p) / 2.0)}) {
        Aabb point;
        point.extend(probe);
        // On the other's surface it is one half; well above that is inside.
        if (other.box.overlaps(point) && winding(mesh, other.triangles, probe) > 0.9) return true;
      }
    }
    return false;
  };
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      if (solids[i].volume6 <= 0.0 || solids[j].volume6 <= 0.0 || !solids[i].box.overlaps(solids[j].box)) continue;
      pairs += enters(solids[i], solids[j]) || enters(solids[j], solids[i]);
    }
  }
  return pairs;
}

void thicken(Mesh& mesh, double thickness) {
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
  const auto loops = boundary_loops(mesh);
  const std::vector<Triangle> sheet = mesh.triangles;
  mesh.vertices.resize(2 * count);
  for (std::size_t v = 0; v < count; ++v) {
    // Mean cosine between the faces around and the way of the vertex: the face moves by it per unit of that way.
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
