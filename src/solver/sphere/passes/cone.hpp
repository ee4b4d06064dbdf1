/// Normal cones: includes shaders/shared/sphere/cone.h as C++ and provides the functions that it requires. A contact
/// may press only along a direction of the cone of its feature.
#pragma once

#include "solver/sphere/shared_code.hpp"

#include <array>

namespace bin_scenes::sphere {

/// The outward normals at a feature, body frame. A face has one normal, and a curved face those of its surroundings; an
/// edge has those between its two faces, and a corner those between its edges. A concave feature has all directions.
struct Cone {
  static constexpr int max_bounds = 6;

  Vec3f axis = Vec3f::Zero();  ///< unit normal of a face, axis of its cone
  float spread = 0;            ///< rad, largest angle between a normal and the axis
  /// Number of bounds of an edge or corner. Without bounds and axis, the cone has all directions.
  int bounds = 0;
  /// The cone is { n : n . bound <= 0 for every bound }; the bounds are unit vectors along the surface.
  std::array<Vec3f, max_bounds> bound = filled();

 private:
  static std::array<Vec3f, max_bounds> filled() {
    std::array<Vec3f, max_bounds> zeros;
    zeros.fill(Vec3f::Zero());
    return zeros;
  }
};

inline uint bounds_of(const Cone& cone) {
  if (cone.bounds > 0) return static_cast<uint>(cone.bounds);
  return cone.axis.isZero() ? 0u : SPHERE_AXIS;
}
inline const Vec3f& bound_at(const Cone& cone, uint i) {
  return cone.bound[i];
}
inline const Vec3f& axis_of(const Cone& cone) {
  return cone.axis;
}
inline float spread_of(const Cone& cone) {
  return cone.spread;
}

#include "shared/sphere/cone.h"

}  // namespace bin_scenes::sphere
