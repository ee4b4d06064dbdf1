/// Poses of a cup whose ring seals on the part. The function knows only the part; scene_search.hpp tries its poses in a
/// scene.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// Returns all grasps that a dense search finds, in the order of the surface points; adds all tried poses to `counts`.
std::vector<Grasp> suction_grasps(const PartModel& part, const Gripper& gripper, GraspCounts& counts);

}  // namespace bin_scenes
