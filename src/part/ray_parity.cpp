#include "ray_parity.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

bool closed(const Mesh& mesh) {
  std::uint64_t sum = 0;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[(k + 1) % 3];
      std::uint64_t hash = (std::min(a, b) << 32) | std::max(a, b);
      hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;  // SplitMix64
      hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
      hash ^= hash >> 31;
      sum += a < b ? hash : 0 - hash;
    }
  }
  return sum == 0;
}

std::optional<int> crossing(const Vec3& a, const Vec3& ab, const Vec3& ac, const Vec3& p) {
  const Vec3& d = ray_direction;
  const Vec3 s = p - a, across = d.cross(ac), along = s.cross(ab);
  const double det = ab.dot(across), u = s.dot(across), v = d.dot(along), w = det - u - v;
  const double longest = std::max(ab.lpNorm<Eigen::Infinity>(), ac.lpNorm<Eigen::Infinity>());
  const double rounding = 1e-14 * longest * (s.lpNorm<Eigen::Infinity>() + longest);
  const double least = std::min({u, v, w}), most = std::max({u, v, w});
  if (least < -rounding && most > rounding) return 0;
  if (least <= rounding && most >= -rounding) return std::nullopt;
  const double distance = ac.dot(along) / det;  // m, times the length of d
  const double height = rounding / std::abs(det) * longest;
  if (std::abs(distance) <= height) return std::nullopt;
  if (distance < 0.0) return 0;
  return det < 0.0 ? 1 : -1;
}

bool ray_meets(const Aabb& box, const Vec3& p) {
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {  // the direction's components are above 0
    first = std::max(first, (box.lower[axis] - p[axis]) / ray_direction[axis]);
    last = std::min(last, (box.upper[axis] - p[axis]) / ray_direction[axis]);
  }
  return first <= last + 1e-12 * (first + box.size().sum());
}

}  // namespace bin_scenes
