/// Grasps of a shape by usual grippers.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

#include <cmath>

namespace bin_scenes::test {

inline Gripper two_fingers() {
  Gripper gripper;
  gripper.name = "two";
  gripper.stroke = 0.05;
  gripper.finger_width = 0.012;
  gripper.pad_length = 0.010;
  gripper.finger_depth = 0.04;
  gripper.finger_thickness = 0.008;
  return gripper;
}

inline Gripper cup() {
  Gripper gripper;
  gripper.name = "cup";
  gripper.type = Gripper::Type::suction;
  gripper.radius = 0.01;
  gripper.lip = 0.001;
  return gripper;
}

inline PartGrasps grasps_of(const Mesh& mesh, const Gripper& gripper, double friction = 0.4) {
  return find_grasps(*PartModel::from_mesh(mesh, "part"), gripper, friction);
}

inline Vec3 closing(const Pose& pose) {
  return pose.orientation * Vec3::UnitX();
}
inline Vec3 approach(const Pose& pose) {
  return pose.orientation * Vec3::UnitZ();
}

/// Mean distance of a rectangle's points from its middle.
inline double mean_distance(double a, double b) {
  const double d = std::hypot(a, b);
  return d / 6.0 + b * b / (12.0 * a) * std::log((a + d) / b) + a * a / (12.0 * b) * std::log((b + d) / a);
}

}  // namespace bin_scenes::test
