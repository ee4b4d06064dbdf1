#include "grasp/rays.hpp"

#include "part/tree_walk.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

bool misses(const Aabb& box, const Vec3& origin, const Vec3& direction, double from) {
  double enter = from, leave = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (origin[k] < box.lower[k] || origin[k] > box.upper[k]) return true;
      continue;
    }
    const double a = (box.lower[k] - origin[k]) / direction[k], b = (box.upper[k] - origin[k]) / direction[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter > leave + 1e-12 * std::abs(leave);
}

/// Moeller & Trumbore 1997, "Fast, minimum storage ray-triangle intersection". A line through a common edge passes
/// through both triangles.
double distance_to(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& origin, const Vec3& direction) {
  constexpr double rim = 1e-12, none = -1.0;
  const Vec3 ab = b - a, ac = c - a, h = direction.cross(ac);
  const double det = ab.dot(h);
  if (std::abs(det) <= 1e-14 * ab.norm() * ac.norm()) return none;
  const Vec3 s = origin - a;
  const double u = s.dot(h) / det;
  if (u < -rim || u > 1.0 + rim) return none;
  const Vec3 q = s.cross(ab);
  const double v = direction.dot(q) / det;
  if (v < -rim || u + v > 1.0 + rim) return none;
  return ac.dot(q) / det;
}

}  // namespace

std::vector<Passage> passages(const MeshQuery& mesh, const Vec3& origin, const Vec3& direction, double from) {
  std::vector<Passage> found;
  const auto& v = mesh.mesh().vertices;
  any_near(
      mesh, [&](const Aabb& box) { return misses(box, origin, direction, from); },
      [&](std::size_t triangle) {
        const Triangle& t = mesh.mesh().triangles[triangle];
        const double distance = distance_to(v[t[0]], v[t[1]], v[t[2]], origin, direction);
        if (distance > from) found.push_back({distance, triangle});
        return false;
      });
  std::sort(found.begin(), found.end(), [](const Passage& a, const Passage& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
  return found;
}

}  // namespace bin_scenes
