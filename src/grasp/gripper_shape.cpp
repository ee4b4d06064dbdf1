#include "grasp/gripper_shape.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

constexpr double cup_height_share = 1.0;  ///< of the radius: the cup; above it the tube, of half the radius

Sweep box(const Vec3& lower, const Vec3& upper, double margin) {
  return Sweep(Pose(), 0.5 * (lower + upper), 0.5 * (upper - lower) + Vec3::Constant(margin));
}

/// Heights of finger tips and palm in the gripper's frame.
double tip_of(const Gripper& g) {
  return g.type == Gripper::Type::parallel ? 0.5 * g.pad_length : 0.0;
}

/// Both fingers, whose inner faces are `inner` and whose outer ones `outer` away from the middle.
void add_fingers(std::vector<Sweep>& all, const Gripper& g, double inner, double outer, double back, double margin) {
  const double tip = tip_of(g), top = tip - g.finger_depth - back, half = 0.5 * g.finger_width;
  all.push_back(box({inner, -half, top}, {outer, half, tip}, margin));
  all.push_back(box({-outer, -half, top}, {-inner, half, tip}, margin));
}

void add_cup(std::vector<Sweep>& all, const Gripper& g, double back, double margin) {
  const double cup = std::min(cup_height_share * g.radius, g.finger_depth);
  all.push_back(Sweep::cylinder(Pose(), g.radius + margin, -cup - back - margin, margin));
  all.push_back(Sweep::cylinder(Pose(), 0.5 * g.radius + margin, -g.finger_depth - back - margin, -cup + margin));
}

void add_palm(std::vector<Sweep>& all, const Gripper& g, double back, double margin) {
  const double top = tip_of(g) - g.finger_depth;
  const Vec3 half = 0.5 * g.palm;
  all.push_back(box({-half.x(), -half.y(), top - g.palm.z() - back}, {half.x(), half.y(), top}, margin));
}

}  // namespace

double opening_of(const Gripper& gripper, double width) {
  return std::min(gripper.opening, 0.5 * std::max(0.0, gripper.travel() - width));
}

std::vector<Sweep> approach_sweeps(const Gripper& g, double width, double back, double margin) {
  std::vector<Sweep> all;
  if (g.type == Gripper::Type::parallel) {
    const double inner = 0.5 * width + opening_of(g, width);
    add_fingers(all, g, inner, inner + g.finger_thickness, back, margin);
  } else {
    add_cup(all, g, back, margin);
  }
  add_palm(all, g, back, margin);
  return all;
}

std::vector<Sweep> closing_sweeps(const Gripper& g, double width, double margin) {
  std::vector<Sweep> all;
  if (g.type == Gripper::Type::parallel) {
    const double inner = 0.5 * width;
    add_fingers(all, g, inner, inner + opening_of(g, width) + g.finger_thickness, 0.0, margin);
  }
  return all;
}

std::vector<Sweep> closed_shape(const Gripper& g, double width, double margin) {
  std::vector<Sweep> all;
  if (g.type == Gripper::Type::parallel) {
    add_fingers(all, g, 0.5 * width, 0.5 * width + g.finger_thickness, 0.0, margin);
  } else {
    add_cup(all, g, 0.0, margin);
  }
  add_palm(all, g, 0.0, margin);
  return all;
}

}  // namespace bin_scenes
