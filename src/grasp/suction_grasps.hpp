/// Poses of a cup whose ring seals on the part.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// Densely, in the order of the surface's points; counts all that was tried.
std::vector<Grasp> suction_grasps(const PartModel& part, const Gripper& gripper, GraspCounts& counts);

}  // namespace bin_scenes
