/// Conventions of contacts that all solvers and the search for grasps share: how the friction of two surfaces is
/// combined, and how the two tangents of a contact are chosen. The forces themselves are computed by each solver.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cmath>

namespace bin_scenes {

/// Returns the coefficient of friction between two surfaces: the geometric mean of their own coefficients (none may be
/// negative).
template <class Number>
Number pair_friction(Number a, Number b) {
  return std::sqrt(a * b);
}

/// Two unit vectors that are perpendicular to a unit normal and to each other. The system (x, y, normal) is
/// right-handed.
struct Tangents {
  explicit Tangents(const Vec3& normal) : x(normal.unitOrthogonal()), y(normal.cross(x)) {}
  Vec3 x, y;
};

}  // namespace bin_scenes
