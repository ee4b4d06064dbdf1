/// Two pads hold a force and a moment about the closing axis together by an ellipsoid (Howe & Cutkosky 1996, "Practical
/// force-motion models for sliding manipulation"). A moment across that axis, of a weight beside the pads, they hold by
/// pressing off their middles and by friction. A cup is torn off when force and tilting moment lift one side of its
/// ring, and slides when friction of the ring gives way (Mahler et al. 2018, "Dex-Net 3.0", equations of its model).
#include "grasp/holding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Largest of a direction within a box, of points from its origin (m).
double farthest(const Aabb& box, const Vec3& direction) {
  return direction.cwiseProduct(box.lower).cwiseMax(direction.cwiseProduct(box.upper)).sum();
}

/// Arm (m) with which the pads' forces alone hold a moment across the closing axis, gripper's frame: the one presses
/// at the near end of its contact, the other at the far end.
double arm_of(const Grasp& grasp, const Vec3& moment) {
  const Vec3 along = Vec3::UnitX().cross(moment.normalized());
  return farthest(grasp.second, along) + farthest(grasp.first, -along);
}

Hold hold_between_pads(const Grasp& grasp, const Pose& pose, const Gripper& g, double friction, const Burden& burden) {
  Vec3 moment = pose.orientation.conjugate() * (burden.center - pose.position).cross(burden.weight);
  // Both pads press with `force`; what they hold along the pads grows with the friction that the slope leaves.
  const double needed = std::hypot(burden.pull, moment.x() / grasp.radius) / (2.0 * g.force);
  const double left = std::max(0.0, friction - grasp.friction - needed);
  moment.x() = 0.0;
  Hold hold;
  hold.friction = grasp.friction + needed;
  hold.score =
      std::max(0.0, 1.0 - grasp.friction / friction) * std::max(0.0, 1.0 - needed / (friction - grasp.friction));
  if (!(moment.norm() > 0.0)) return hold;
  // What the arm does not hold, friction does that pulls the one way at one pad and the other way at the other.
  const double lever = moment.norm() / g.force, arm = arm_of(grasp, moment);
  hold.friction += std::max(0.0, lever - arm) / grasp.width;
  hold.score *= std::max(0.0, 1.0 - lever / (arm + left * grasp.width));
  return hold;
}

Hold hold_by_cup(const Grasp& grasp, const Pose& pose, const Gripper& g, double friction, const Burden& burden) {
  const Vec3 axis = pose.orientation * Vec3::UnitZ();
  const Vec3 force = -burden.pull * burden.up;
  const double along = std::max(0.0, force.dot(axis));  // pulls the part from the cup
  const double across = (force - force.dot(axis) * axis).norm();
  const Vec3 moment = (burden.center - pose.position).cross(burden.weight);
  const double tilting = (moment - moment.dot(axis) * axis).norm();
  const double vacuum = g.force - g.stiffness * grasp.gap;  // the lip, pressed into its gap, pushes back
  Hold hold;
  const double torn = (along + tilting / grasp.radius) / vacuum;
  if (!(vacuum > 0.0) || torn >= 1.0) {
    hold.friction = never;
    return hold;
  }
  hold.friction = across / (vacuum - along);
  hold.score = (1.0 - grasp.gap / g.lip) * (1.0 - torn) * std::max(0.0, 1.0 - hold.friction / friction);
  return hold;
}

}  // namespace

Hold hold_of(const Grasp& grasp, const Pose& pose, const Gripper& gripper, double friction, const Burden& burden) {
  return gripper.type == Gripper::Type::parallel ? hold_between_pads(grasp, pose, gripper, friction, burden)
                                                 : hold_by_cup(grasp, pose, gripper, friction, burden);
}

}  // namespace bin_scenes
