/// Whether a grasp holds a part that is lifted. It computes the static safety of a grasp from contacts, friction and
/// load; the dynamic proof by a simulated lift is in pour/prover.hpp.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// The forces that a grasp has to hold, bin frame.
struct Burden {
  double pull;  ///< N, force to overcome along `up`: weight, inertia, load and friction of the neighbours
  Vec3 weight;  ///< N: weight and inertial force of the part alone
  Vec3 center;  ///< m: centre of mass of the part
  Vec3 up;      ///< unit vector: direction of the lift
};

struct Hold {
  double safety = 0.0;    ///< factor by which the burden can grow until the part slips or turns; below 1: it does
  double sliding = 0.0;   ///< factor by which the burden can grow until the part slides out; turning is disregarded
  double friction = 0.0;  ///< smallest friction coefficient with which the grasp holds; infinite: it never holds
  double moment = 0.0;    ///< moment of the weight / moment that the grasp can hold; at 1 and more, the part turns
};

/// Computes how safely a grasp holds. @param pose  pose of the gripper in the bin frame
Hold hold_of(const Grasp& grasp, const Pose& pose, const Gripper& gripper, double friction, const Burden& burden);

/// Returns the force (N) of the vacuum of a cup, reduced by leakage through the gap under its lip.
double vacuum_of(const Grasp& grasp, const Gripper& gripper);

}  // namespace bin_scenes
