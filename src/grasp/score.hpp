/// The score of a grasp from its columns. The weights belong to the gripper, so that they can be fitted to the success
/// rates of simulated lifts.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/holding.hpp"

namespace bin_scenes {

/// Returns the columns that do not depend on neighbours and images: safety, sliding, antipodal, moment, overlap,
/// upright and closing.
/// @param tilt  angle between the approach and gravity (rad)
GraspColumns columns_of(const Grasp& grasp, const Hold& hold, const Gripper& gripper, double friction, double tilt);

/// Returns the score 1 / (1 + exp(-(bias + sum of weight * column))), with the weights of the gripper. For the safety
/// factors, the logarithm is used.
double score_of(const GraspColumns& columns, const Gripper& gripper);

}  // namespace bin_scenes
