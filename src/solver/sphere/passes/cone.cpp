#include "solver/sphere/passes/cone.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

constexpr int sweeps = 8;           ///< of cyclic projection; two suffice where the bounds are perpendicular
constexpr float least_left = 0.1f;  ///< of a unit direction: what leans over more than 84 degrees does not press

}  // namespace

bool Cone::restrict(Vec3f& direction, float least) const {
  if (bounds > 0) {
    Vec3f n = direction;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      float outside = 0;
      for (int i = 0; i < bounds; ++i) {
        const float over = n.dot(bound[i]);
        if (over <= 0) continue;
        outside = std::max(outside, over);
        n -= over * bound[i];
      }
      if (outside < 1e-5f) break;
    }
    const float left = n.norm();
    if (left < least) return false;  // not the cosine of n / left: far outside, n may lie askew yet, and is short
    direction = n / left;
    return true;
  }
  if (axis.isZero()) return true;
  const float along = axis.dot(direction);
  if (along < least_left) return false;
  const Vec3f across = direction - along * axis;
  const float side = across.norm();
  if (std::atan2(side, along) <= spread) return true;
  const Vec3f turned = std::cos(spread) * axis + (std::sin(spread) / side) * across;
  if (turned.dot(direction) < least) return false;
  direction = turned;
  return true;
}

Vec3f Cone::middle() const {
  Vec3f sum = axis;
  for (int i = 0; i < bounds; ++i) sum -= bound[i];
  return sum.normalized();  // of 0: 0
}

}  // namespace bin_scenes::sphere
