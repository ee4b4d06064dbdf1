/// One number from the columns of a grasp.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/holding.hpp"

namespace bin_scenes {

/// Those that do not depend on neighbours and images: safety, antipodal, moment, overlap, upright, closing.
/// @param tilt  rad, angle of approach and gravity
GraspColumns columns_of(const Grasp& grasp, const Hold& hold, const Gripper& gripper, double friction, double tilt);

/// 0..1.
double score_of(const GraspColumns& columns, const ScoreWeights& weights);

}  // namespace bin_scenes
