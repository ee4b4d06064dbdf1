/// Single-precision vocabulary of the sphere solver: what a GPU pass and its CPU twin both compute with.
#pragma once

#include "bin_scenes/core/types.hpp"

namespace bin_scenes::sphere {

using Vec3f = Eigen::Vector3f;
using Mat3f = Eigen::Matrix3f;
using Quatf = Eigen::Quaternionf;

/// q advanced by the angular velocity w (rad/s, parent frame) over h seconds: exact exponential map.
inline Quatf integrated(const Quatf& q, const Vec3f& w, float h) {
  const float angle = w.norm() * h;
  if (angle < 1e-12f) return q;
  const float s = std::sin(0.5f * angle) * h / angle;
  return (Quatf(std::cos(0.5f * angle), s * w.x(), s * w.y(), s * w.z()) * q).normalized();
}

}  // namespace bin_scenes::sphere
