/// Provides GLSL's names for Eigen's types and functions, so that the code of shaders/shared/sphere can be compiled as
/// C++ as well. Both forms of the solver thereby execute the same text. It is included inside a namespace by the passes
/// that use shared code.
#pragma once

#include "shared/language.h"
#include "shared/sphere/constants.h"
#include "solver/sphere/math.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bin_scenes::sphere {

using vec3 = Vec3f;
using mat3 = Mat3f;
using uint = std::uint32_t;
using std::abs, std::ceil, std::cos, std::floor, std::max, std::min, std::sin, std::sqrt;

inline float atan(float y, float x) {
  return std::atan2(y, x);
}
inline float dot(const vec3& a, const vec3& b) {
  return a.dot(b);
}
inline float length(const vec3& v) {
  return v.norm();
}
inline vec3 cross(const vec3& a, const vec3& b) {
  return a.cross(b);
}
/// Returns the unit vector along v; 0 if v is 0.
inline vec3 unit(const vec3& v) {
  return v.normalized();
}
/// Rotates a vector by the transpose of m: from the frame into which m rotates back to the original one.
inline vec3 turned_back(const mat3& m, const vec3& v) {
  return m.transpose() * v;
}

#include "shared/sphere/plan.h"
#include "shared/sphere/row.h"

}  // namespace bin_scenes::sphere
