/// The score of a grasp from its columns. The weights belong to the gripper, so that they can be fitted to the success
/// rates of simulated lifts.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/holding.hpp"

namespace bin_scenes {

/// The columns that do not depend on neighbours and images: safety, sliding, antipodal, moment, overlap, upright,
/// closing.
/// @param tilt  rad, angle of approach and gravity
GraspColumns columns_of(const Grasp& grasp, const Hold& hold, const Gripper& gripper, double friction, double tilt);

/// 1 / (1 + exp(-(bias + sum of weight * column))), with the gripper's weights; the safety factors count by their
/// logarithms.
double score_of(const GraspColumns& columns, const Gripper& gripper);

}  // namespace bin_scenes
