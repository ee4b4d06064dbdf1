#include "crossings.hpp"

#include <algorithm>
#include <numeric>

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

bool over(const TrianglePoints& t, const Vec3& normal, const Vec3& x, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = t[(i + 1) % 3] - t[i];
    if (normal.cross(edge).dot(x - t[i]) < -tolerance * edge.norm()) return false;
  }
  return true;
}

/// Points where the edges of s pierce t.
void pierce(const TrianglePoints& s, const std::array<double, 3>& height, const TrianglePoints& t, const Vec3& normal,
            double tolerance, Vec3& sum, int& count, Aabb& box) {
  const auto add = [&](const Vec3& x) {
    if (!over(t, normal, x, tolerance)) return;
    sum += x;
    ++count;
    box.extend(x);
  };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (height[i] == 0.0) add(s[i]);
    if (height[i] * height[j] < 0.0) add(s[i] + height[i] / (height[i] - height[j]) * (s[j] - s[i]));
  }
}

}  // namespace

std::optional<Crossing> crossing(const TrianglePoints& s, const TrianglePoints& t, double tolerance) {
  const Vec3 ns = (s[1] - s[0]).cross(s[2] - s[0]), nt = (t[1] - t[0]).cross(t[2] - t[0]);
  const double ls = ns.norm(), lt = nt.norm();
  if (ls == 0.0 || lt == 0.0) return std::nullopt;
  std::array<double, 3> hs, ht;
  if (!heights(s, t, nt / lt, tolerance, hs) || !heights(t, s, ns / ls, tolerance, ht)) return std::nullopt;
  Crossing found{Vec3::Zero(), {}, {}};
  int count = 0;
  pierce(s, hs, t, nt / lt, tolerance, found.point, count, found.box);
  pierce(t, ht, s, ns / ls, tolerance, found.point, count, found.box);
  if (count == 0) return std::nullopt;
  found.point /= count;
  return found;
}

std::vector<Crossing> crossings(const MeshQuery& a, const MeshQuery& b, const Pose& b_in_a, double tolerance) {
  std::vector<Crossing> found;
  const BoxMotion to_a(b_in_a), to_b(b_in_a.inverse());
  walk(
      a, b,
      [&](const Aabb& box_a, const Aabb& box_b) {
        const double gap = axis_gap(box_a, to_a(box_b));
        return gap > tolerance ? gap : std::max(gap, axis_gap(to_b(box_a), box_b));
      },
      [&] { return tolerance + std::numeric_limits<double>::min(); },
      [&](std::size_t i, std::size_t j) {
        const TrianglePoints s = points_of(a.mesh(), a.leaf_triangle(i));
        const TrianglePoints t = moved(b_in_a, points_of(b.mesh(), b.leaf_triangle(j)));
        if (!bounds(s).overlaps(bounds(t), tolerance)) return;
        if (auto common = crossing(s, t, tolerance)) {
          common->triangles = {a.leaf_triangle(i), b.leaf_triangle(j)};
          found.push_back(*common);
        }
      });
  return found;
}

std::vector<std::vector<std::size_t>> connected(const std::vector<Crossing>& crossings, double tolerance) {
  const std::size_t count = crossings.size();
  std::vector<std::size_t> order(count), parent(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto left = [&](std::size_t i) { return crossings[i].box.lower.x(); };
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return left(i) != left(j) ? left(i) < left(j) : i < j; });
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<std::size_t> active;
  for (const std::size_t i : order) {
    active.erase(std::remove_if(active.begin(), active.end(),
                                [&](std::size_t j) { return crossings[j].box.upper.x() + tolerance < left(i); }),
                 active.end());
    for (const std::size_t j : active) {
      if (!crossings[i].box.overlaps(crossings[j].box, tolerance)) continue;
      const std::size_t r = root(i), s = root(j);
      parent[std::max(r, s)] = std::min(r, s);
    }
    active.push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> group_of(count, count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t r = root(i);  // the smallest of its group, so it comes first
    if (r == i) {
      group_of[i] = groups.size();
      groups.emplace_back();
    }
    groups[group_of[r]].push_back(i);
  }
  return groups;
}

}  // namespace bin_scenes
