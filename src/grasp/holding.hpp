/// Whether a grasp holds a part that is lifted.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// What a grasp has to hold, bin frame.
struct Burden {
  double pull;  ///< N against `up`: weight, inertia, load and friction
  Vec3 weight;  ///< N: weight and inertia of the part
  Vec3 center;  ///< m: of mass
  Vec3 up;      ///< unit
};

struct Hold {
  double safety = 0.0;    ///< factor by which the burden could grow before the part slips; below 1: it slips
  double sliding = 0.0;   ///< the same for sliding alone, whatever the part turns in the gripper
  double friction = 0.0;  ///< smallest coefficient that suffices; infinite: none does
  double moment = 0.0;    ///< moment of the weight / moment that is held; 1 and more: not held
};

/// @param pose  of the gripper in the bin frame
Hold hold_of(const Grasp& grasp, const Pose& pose, const Gripper& gripper, double friction, const Burden& burden);

/// N, suction: what the vacuum holds with the gap that the grasp leaves.
double vacuum_of(const Grasp& grasp, const Gripper& gripper);

}  // namespace bin_scenes
