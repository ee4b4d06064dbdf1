/// Whether a grasp holds a part that is lifted.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// What it has to hold, bin frame.
struct Burden {
  double pull;  ///< N against `up`: weight, load and friction
  Vec3 weight;  ///< N
  Vec3 center;  ///< m: of mass
  Vec3 up;      ///< unit
};

struct Hold {
  double score = 0.0;     ///< 0: it slips
  double friction = 0.0;  ///< smallest coefficient that suffices; infinite: none does
};

/// @param pose  of the gripper in the bin frame
Hold hold_of(const Grasp& grasp, const Pose& pose, const Gripper& gripper, double friction, const Burden& burden);

}  // namespace bin_scenes
