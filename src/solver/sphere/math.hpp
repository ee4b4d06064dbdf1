/// Vectors, rotations and poses in single precision, with which the CPU passes of the default solver compute exactly
/// what their GPU form computes. The rest of the program uses the double-precision types of core/types.hpp.
#pragma once

#include "bin_scenes/core/types.hpp"

namespace bin_scenes::sphere {

using Vec3f = Eigen::Vector3f;
using Mat3f = Eigen::Matrix3f;
using Quatf = Eigen::Quaternionf;

/// Returns q after h seconds of rotation at the angular velocity w (rad/s, parent frame), by the exact exponential map.
inline Quatf integrated(const Quatf& q, const Vec3f& w, float h) {
  const float angle = w.norm() * h;
  if (angle < 1e-12f) return q;
  const float s = std::sin(0.5f * angle) * h / angle;
  return (Quatf(std::cos(0.5f * angle), s * w.x(), s * w.y(), s * w.z()) * q).normalized();
}

/// Adds `change` to `sum`, and keeps in `rest` what single precision cannot represent until the next call: a part at
/// 1,000 m/s, a kilometre away, moves by 40 mm in a divided step, and would be rounded to 0.06 mm.
inline void add_exactly(const Vec3f& change, Vec3f& sum, Vec3f& rest) {
  const Vec3 exact = sum.cast<double>() + (rest.cast<double>() + change.cast<double>());
  sum = exact.cast<float>();
  rest = (exact - sum.cast<double>()).cast<float>();
}

}  // namespace bin_scenes::sphere
