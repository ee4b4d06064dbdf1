/// Whether a grasp holds a part that is lifted. It computes the static safety of a grasp from contacts, friction and
/// load; the dynamic proof by a simulated lift is in pour/prover.hpp.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// The forces that a grasp has to hold, bin frame.
struct Burden {
  double pull;  ///< N against `up`: weight, inertia, load and friction of the neighbours
  Vec3 weight;  ///< N: weight and inertia of the part alone
  Vec3 center;  ///< m: centre of mass
  Vec3 up;      ///< unit: direction of the lift
};

struct Hold {
  double safety = 0.0;    ///< factor by which the burden could grow before the part slips or turns; below 1: it does
  double sliding = 0.0;   ///< factor by which it could grow before the part slides out, even if it turns before
  double friction = 0.0;  ///< smallest coefficient that suffices; infinite: none does
  double moment = 0.0;    ///< moment of the weight / moment that the grasp can hold; 1 and more: the part turns
};

/// @param pose  of the gripper in the bin frame
Hold hold_of(const Grasp& grasp, const Pose& pose, const Gripper& gripper, double friction, const Burden& burden);

/// Suction: force of the vacuum (N) after the loss by the gap under the lip.
double vacuum_of(const Grasp& grasp, const Gripper& gripper);

}  // namespace bin_scenes
