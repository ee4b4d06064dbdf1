/// Friction of two pads holds a force together with a moment about the closing axis; the limit is an ellipsoid (Howe &
/// Cutkosky 1996, "Practical force-motion models for sliding manipulation"). The pads hold a moment across that axis,
/// for example of a weight beside the pads, because their pressure moves away from their centres, and by friction. A
/// cup is torn off if force and tilting moment lift one side of its ring, and slides if the friction of the ring is
/// exceeded (Mahler et al. 2018, "Dex-Net 3.0").
#include "grasp/holding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Largest coordinate of a box along a direction (m).
double farthest(const Aabb& box, const Vec3& direction) {
  return direction.cwiseProduct(box.lower).cwiseMax(direction.cwiseProduct(box.upper)).sum();
}

/// Arm (m) with which the closing forces alone hold a moment across the closing axis (gripper's frame): one pad presses
/// at one end of its contact, the other pad at the opposite end. Forces of fingers within a hole point outwards.
double arm_of(const Grasp& grasp, const Vec3& moment) {
  const Vec3 along = Vec3::UnitX().cross((grasp.inner ? -1.0 : 1.0) * moment.normalized());
  return farthest(grasp.second, along) + farthest(grasp.first, -along);
}

/// If the burden is k times as large, the pads need the coefficient
/// slope + k * across + max(0, k * lever - arm) / width.
Hold hold_between_pads(const Grasp& grasp, const Pose& pose, const Gripper& g, double friction, const Burden& burden) {
  Vec3 moment = pose.orientation.conjugate() * (burden.center - pose.position).cross(burden.weight);
  const double twist = std::abs(moment.x()) / grasp.radius;  // about the closing axis
  const double across = std::hypot(burden.pull, twist) / (2.0 * g.force);
  moment.x() = 0.0;
  const bool turns = moment.norm() > 0.0;
  const double lever = turns ? moment.norm() / g.force : 0.0, arm = turns ? arm_of(grasp, moment) : 0.0;
  const double spare = friction - grasp.friction;
  Hold hold;
  hold.friction = grasp.friction + across + std::max(0.0, lever - arm) / grasp.width;
  hold.safety = spare / across;
  hold.sliding = spare * 2.0 * g.force / burden.pull;
  if (hold.safety * lever > arm) hold.safety = (spare * grasp.width + arm) / (across * grasp.width + lever);
  const double held = arm + std::max(0.0, spare - across) * grasp.width;
  hold.moment = std::hypot(twist / (2.0 * g.force * std::max(spare, 1e-9)), turns ? lever / held : 0.0);
  return hold;
}

Hold hold_by_cup(const Grasp& grasp, const Pose& pose, const Gripper& g, double friction, const Burden& burden) {
  const Vec3 axis = pose.orientation * Vec3::UnitZ();
  const Vec3 force = -burden.pull * burden.up;
  const double along = std::max(0.0, force.dot(axis));  // pulls the part from the cup
  const double across = (force - force.dot(axis) * axis).norm();
  const Vec3 moment = (burden.center - pose.position).cross(burden.weight);
  const double tilting = (moment - moment.dot(axis) * axis).norm();
  const double vacuum = vacuum_of(grasp, g);
  Hold hold;
  hold.friction = never;
  hold.moment = 1.0;
  if (!(vacuum > 0.0)) return hold;
  const double torn = (along + tilting / grasp.radius) / vacuum, slides = (across / friction + along) / vacuum;
  hold.safety = 1.0 / std::max(torn, slides);
  hold.sliding = 1.0 / slides;
  if (torn >= 1.0) return hold;
  hold.friction = across / (vacuum - along);
  hold.moment = tilting / (grasp.radius * (vacuum - along));
  return hold;
}

}  // namespace

double vacuum_of(const Grasp& grasp, const Gripper& gripper) {
  // The flow through a slit grows with the cube of its height; at the widest gap that the lip can close, half of the
  // vacuum is left. The lip, which is pressed into the gap, pushes back.
  const double leak = grasp.gap / gripper.lip;
  return gripper.force / (1.0 + leak * leak * leak) - gripper.stiffness * grasp.gap;
}

Hold hold_of(const Grasp& grasp, const Pose& pose, const Gripper& gripper, double friction, const Burden& burden) {
  return gripper.type == Gripper::Type::parallel ? hold_between_pads(grasp, pose, gripper, friction, burden)
                                                 : hold_by_cup(grasp, pose, gripper, friction, burden);
}

}  // namespace bin_scenes
