/// Conventions of contacts that all solvers and grasps share.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cmath>

namespace bin_scenes {

/// Coefficient of friction between two surfaces: the geometric mean of theirs.
template <class Number>
Number pair_friction(Number a, Number b) {
  return std::sqrt(a * b);
}

/// Two directions that are perpendicular to a normal and to each other; x, y, normal are right-handed.
struct Tangents {
  explicit Tangents(const Vec3& normal) : x(normal.unitOrthogonal()), y(normal.cross(x)) {}
  Vec3 x, y;
};

}  // namespace bin_scenes
