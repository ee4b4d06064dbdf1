/// Walks the trees of two meshes together down to pairs of triangles and finds where edges of one pierce the other.
#include "crossings.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/disjoint_sets.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace bin_scenes {

namespace {

/// Corners' heights over the plane of `t`, small ones as zero; false if all lie on one side of it, or all in it.
bool heights(const TrianglePoints& s, const TrianglePoints& t, const Vec3& normal, double tolerance,
             std::array<double, 3>& height) {
  bool above = false, below = false, in = false;
  for (int i = 0; i < 3; ++i) {
    height[i] = normal.dot(s[i] - t[0]);
    if (std::abs(height[i]) <= tolerance) height[i] = 0.0;
    above |= height[i] > 0.0;
    below |= height[i] < 0.0;
    in |= height[i] == 0.0;
  }
  return (above && below) || (in && (above || below));
}

/// What of the coordinate `axis` the plane at these heights cuts out of a triangle.
std::pair<double, double> interval(const TrianglePoints& s, const std::array<double, 3>& height, int axis) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto add = [&](double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double from = s[i][axis], to = s[j][axis];
    if (height[i] == 0.0) add(from);
    if (height[i] * height[j] < 0.0) add(from + height[i] / (height[i] - height[j]) * (to - from));
  }
  return {low, high};
}

/// Whether the triangles lie one after the other on the line that their planes share (Moeller 1997), seen along the
/// axis nearest to it. Most of what long slivers meet does.
bool one_after_the_other(const TrianglePoints& s, const std::array<double, 3>& hs, const TrianglePoints& t,
                         const std::array<double, 3>& ht, const Vec3& line, double tolerance) {
  constexpr double wide = 1e3;  // tolerances: a corner that only touches an edge at a shallow angle is near it for long
  int axis;
  line.cwiseAbs().maxCoeff(&axis);
  const auto [low_s, high_s] = interval(s, hs, axis);
  const auto [low_t, high_t] = interval(t, ht, axis);
  return low_s > high_t + wide * tolerance || low_t > high_s + wide * tolerance;
}

bool over(const TrianglePoints& t, const Vec3& normal, const Vec3& x, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = t[(i + 1) % 3] - t[i];
    const double inward = normal.cross(edge).dot(x - t[i]);
    if (inward < 0.0 && inward < -tolerance * edge.norm()) return false;
  }
  return true;
}

struct Pierced {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  Aabb box;
};

/// Points where the edges of s, whose corners have these heights over t, pierce t.
void pierce(const TrianglePoints& s, const std::array<double, 3>& height, const Facet& t, double tolerance,
            Pierced& points) {
  const auto add = [&](const Vec3& x) {
    if (!over(t.points, t.normal(), x, tolerance)) return;
    points.sum += x;
    ++points.count;
    points.box.extend(x);
  };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (height[i] == 0.0) add(s[i]);
    if (height[i] * height[j] < 0.0) add(s[i] + height[i] / (height[i] - height[j]) * (s[j] - s[i]));
  }
}

}  // namespace

std::optional<Crossing> crossing(const Facet& s, const Facet& t, double tolerance) {
  if (s.normal().isZero() || t.normal().isZero()) return std::nullopt;
  std::array<double, 3> hs, ht;
  if (!heights(s.points, t.points, t.normal(), tolerance, hs)) return std::nullopt;
  if (!heights(t.points, s.points, s.normal(), tolerance, ht)) return std::nullopt;
  if (one_after_the_other(s.points, hs, t.points, ht, s.normal().cross(t.normal()), tolerance)) return std::nullopt;
  Pierced points;
  pierce(s.points, hs, t, tolerance, points);
  pierce(t.points, ht, s, tolerance, points);
  if (points.count == 0) return std::nullopt;
  BIN_SCENES_ASSERT(points.sum.allFinite() && points.count <= 12);  // six edges, each with its end and a point inside
  return Crossing{points.sum / points.count, points.box, {s.triangle, t.triangle}};
}

std::vector<Crossing> crossings(const MeshQuery& a, const MeshQuery& b, const Pose& b_in_a, double tolerance) {
  std::vector<Crossing> found;
  if (a.nodes().empty() || b.nodes().empty()) return found;
  const NodePair pair(a, b, b_in_a, tolerance);
  PlacedLeaf leaf_a(a, Pose()), leaf_b(b, b_in_a);
  static thread_local std::vector<std::array<std::uint32_t, 2>> stack;  // kept for its memory
  stack.assign(1, {0, 0});
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    if (pair.apart(i, j)) continue;
    const MeshQuery::Node &one = a.nodes()[i], &other = b.nodes()[j];
    if (one.count && other.count) {
      stop_if_cancelled();
      const auto &facets_a = leaf_a.of(i), &facets_b = leaf_b.of(j);
      for (std::uint32_t s = 0; s < one.count; ++s)
        for (std::uint32_t t = 0; t < other.count; ++t) {
          if (!facets_a[s].box.overlaps(facets_b[t].box, tolerance)) continue;
          if (const auto common = crossing(facets_a[s], facets_b[t], tolerance)) found.push_back(*common);
        }
      continue;
    }
    const bool open_a = other.count || (!one.count && pair.larger(i, j));
    stack.push_back(open_a ? std::array{one.first, j} : std::array{i, other.first});
    stack.push_back(open_a ? std::array{i + 1, j} : std::array{i, j + 1});
  }
  // Not in the order of the walk, which is a matter of rounding.
  std::sort(found.begin(), found.end(), [](const Crossing& s, const Crossing& t) { return s.triangles < t.triangles; });
  BIN_SCENES_ASSERT(std::adjacent_find(found.begin(), found.end(), [](const Crossing& s, const Crossing& t) {
                      return !(s.triangles < t.triangles);
                    }) == found.end());  // each pair of leaves is visited once
  return found;
}

std::vector<std::vector<std::size_t>> connected(const std::vector<Crossing>& crossings, double tolerance) {
  const std::size_t count = crossings.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  DisjointSets sets(count);
  const auto left = [&](std::size_t i) { return crossings[i].box.lower.x(); };
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return left(i) != left(j) ? left(i) < left(j) : i < j; });
  std::vector<std::size_t> active;
  for (const std::size_t i : order) {
    active.erase(std::remove_if(active.begin(), active.end(),
                                [&](std::size_t j) { return crossings[j].box.upper.x() + tolerance < left(i); }),
                 active.end());
    for (const std::size_t j : active)
      if (crossings[i].box.overlaps(crossings[j].box, tolerance))
        sets.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    active.push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> group_of(count, count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t r = sets.root(static_cast<std::uint32_t>(i));  // the smallest of its group, so it comes first
    if (r == i) {
      group_of[i] = groups.size();
      groups.emplace_back();
    }
    groups[group_of[r]].push_back(i);
  }
  BIN_SCENES_ASSERT(
      each_is(groups, [](const std::vector<std::size_t>& group) { return !group.empty() && ascends(group); }));
  return groups;
}

}  // namespace bin_scenes
