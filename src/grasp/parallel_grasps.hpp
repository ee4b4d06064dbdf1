/// Poses of a two-finger gripper whose pads meet the part from opposite sides, or two walls of a hole from within.
/// These functions know only the part, not its neighbours; scene_search.hpp applies them to a scene.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

#include <functional>

namespace bin_scenes {

struct ParallelGrasps {
  std::vector<Grasp> grasps;
  std::vector<ClosingAxis> axes;  ///< those on which at least one grasp was found
};

/// All grasps that a dense search finds, in the order of the points of the surface; counts all poses that were tried.
/// The gripper is turned about each closing axis in steps, starting at the first of `directions` that is across it.
ParallelGrasps parallel_grasps(const PartModel& part, const Gripper& gripper, double friction,
                               const std::vector<Vec3>& directions, GraspCounts& counts);

/// Whether nothing obstructs the gripper at a pose in the model frame.
using IsClear = std::function<bool(const Pose& pose, const Aperture& at)>;

/// Presses the pads onto the part, which they meet at about the aperture `guess`; the closing axis is x of the pose.
/// None, and counted, if the pads do not hold the part, or if `is_clear` is given and false where they touch it.
std::optional<Grasp> close_fingers(const PartModel& part, const Gripper& gripper, double friction, const Pose& pose,
                                   const Aperture& guess, GraspCounts& counts, const IsClear& is_clear = {});

/// Whether the gripper collides with the part itself while it approaches or closes. Pads that touch the part do not
/// collide with it.
bool goes_through(const PartModel& part, const Gripper& gripper, const Grasp& grasp);

}  // namespace bin_scenes
