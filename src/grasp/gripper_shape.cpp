#include "grasp/gripper_shape.hpp"

#include <algorithm>
#include <array>

namespace bin_scenes {

namespace {

constexpr double cup_height_share = 1.0;  ///< height of the cup / its radius; above it is a tube of half the radius

Sweep box(const Vec3& lower, const Vec3& upper, double margin) {
  return Sweep(Pose(), 0.5 * (lower + upper), 0.5 * (upper - lower) + Vec3::Constant(margin));
}

/// Height of the finger tips in the gripper's frame.
double tip_of(const Gripper& g) {
  return g.type == Gripper::Type::parallel ? 0.5 * g.pad_length : 0.0;
}

/// Both fingers with their inner faces at any distance between `near` and `far` from the gripper's centre plane.
void add_fingers(std::vector<Sweep>& all, const Gripper& g, double near, double far, double back, double margin) {
  for (const Aabb& part : finger_of(g)) {
    const Vec3 lower(part.lower.x() + near, part.lower.y(), part.lower.z() - back);
    const Vec3 upper(part.upper.x() + far, part.upper.y(), part.upper.z());
    all.push_back(box(lower, upper, margin));
    all.push_back(box({-upper.x(), -upper.y(), lower.z()}, {-lower.x(), -lower.y(), upper.z()}, margin));
  }
}

/// Distance of the inner faces of the fingers from the gripper's centre plane when the pads touch the part, and when
/// the fingers are opened.
double closed_at(const Gripper& g, const Aperture& at) {
  return 0.5 * g.between_fingers(at);
}
double opened_at(const Gripper& g, const Aperture& at) {
  return closed_at(g, at) + (at.inner ? -1.0 : 1.0) * g.opened(at);
}

void add_cup(std::vector<Sweep>& all, const Gripper& g, double back, double margin) {
  const double cup = std::min(cup_height_share * g.radius, g.finger_depth);
  all.push_back(Sweep::cylinder(Pose(), g.radius + margin, -cup - back - margin, margin));
  all.push_back(Sweep::cylinder(Pose(), 0.5 * g.radius + margin, -g.finger_depth - back - margin, -cup + margin));
}

/// The palm has the axes of the flange, but moves along the axis of the gripper.
void add_palm(std::vector<Sweep>& all, const Gripper& g, double back, double margin) {
  const double top = tip_of(g) - g.finger_depth;
  const Vec3 half = 0.5 * g.palm;
  if (g.tool_rotation.isZero()) {
    all.push_back(box({-half.x(), -half.y(), top - g.palm.z() - back}, {half.x(), half.y(), top}, margin));
    return;
  }
  const Pose flange = g.flange();
  const Sweep palm(flange, Vec3(0.0, 0.0, half.z()), half + Vec3::Constant(margin));
  all.push_back(back > 0.0 ? palm.moved(Vec3(0.0, 0.0, -back)) : palm);
}

}  // namespace

std::vector<Aabb> finger_of(const Gripper& g) {
  if (!g.finger_boxes.empty()) return g.finger_boxes;
  const double tip = tip_of(g), half = 0.5 * g.finger_width;
  return {{Vec3(0.0, -half, tip - g.finger_depth), Vec3(g.finger_thickness, half, tip)}};
}

std::vector<Sweep> approach_sweeps(const Gripper& g, const Aperture& at, double back, double margin) {
  std::vector<Sweep> all;
  if (g.type == Gripper::Type::parallel)
    add_fingers(all, g, opened_at(g, at), opened_at(g, at), back, margin);
  else
    add_cup(all, g, back, margin);
  add_palm(all, g, back, margin);
  return all;
}

std::vector<Sweep> closing_sweeps(const Gripper& g, const Aperture& at, double margin) {
  std::vector<Sweep> all;
  if (g.type == Gripper::Type::parallel) {
    const auto [near, far] = std::minmax({closed_at(g, at), opened_at(g, at)});
    add_fingers(all, g, near, far, 0.0, margin);
  }
  return all;
}

std::vector<Sweep> closed_shape(const Gripper& g, const Aperture& at, double margin) {
  std::vector<Sweep> all;
  if (g.type == Gripper::Type::parallel)
    add_fingers(all, g, closed_at(g, at), closed_at(g, at), 0.0, margin);
  else
    add_cup(all, g, 0.0, margin);
  add_palm(all, g, 0.0, margin);
  return all;
}

}  // namespace bin_scenes
