/// Basic types of the whole library: vectors, poses, velocities and boxes. All quantities are in SI units (m, kg, s,
/// rad), in right-handed frames with z up, in double precision. A function that takes or returns a pose states between
/// which frames it maps.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace bin_scenes {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  ///< has unit length wherever it represents an orientation

/// Rigid transform from a body's frame to its parent's frame: x_parent = orientation * x_body + position.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();

  Vec3 operator*(const Vec3& point) const { return orientation * point + position; }
  Pose operator*(const Pose& child) const {
    return {*this * child.position, (orientation * child.orientation).normalized()};
  }
  Pose inverse() const {
    const Quat back = orientation.conjugate();
    return {-(back * position), back};
  }
  bool finite() const { return position.allFinite() && orientation.coeffs().allFinite(); }
  /// Returns the pose that stands for "not in the scene". Its position is NaN.
  static Pose none() { return {Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), Quat::Identity()}; }
};

/// Velocity of a rigid body's centre of mass (m/s) and its angular velocity (rad/s), both in the parent's frame.
struct Twist {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
};

/// An axis-aligned box. It is empty (lower > upper) until it is first extended.
struct Aabb {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vec3& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  void extend(const Aabb& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  bool empty() const { return (lower.array() > upper.array()).any(); }
  Vec3 size() const { return upper - lower; }
  Vec3 center() const { return 0.5 * (lower + upper); }
  double diagonal() const { return empty() ? 0.0 : size().norm(); }
  bool overlaps(const Aabb& other, double margin = 0.0) const {
    return ((lower.array() - margin) <= other.upper.array()).all() &&
           ((other.lower.array() - margin) <= upper.array()).all();
  }
};

}  // namespace bin_scenes
