/// Poses of a two-finger gripper whose pads meet the part from opposite sides.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

/// Densely, in the order of the surface's points; counts all that was tried.
std::vector<Grasp> parallel_grasps(const PartModel& part, const Gripper& gripper, double friction, GraspCounts& counts);

/// The pads pressed onto the part, with the closing axis through `middle` along `closing`. None, and counted, if they
/// do not hold it.
std::optional<Grasp> close_fingers(const PartModel& part, const Gripper& gripper, double friction, const Pose& pose,
                                   double guess, GraspCounts& counts);

}  // namespace bin_scenes
