/// Poses of a two-finger gripper whose pads meet the part from opposite sides, or two walls of a hole from within.
/// These functions know only the part, not its neighbours; scene_search.hpp applies them to a scene.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

#include <functional>

namespace bin_scenes {

struct ParallelGrasps {
  std::vector<Grasp> grasps;
  std::vector<ClosingAxis> axes;  ///< closing axes on which at least one grasp was found
};

/// Returns all grasps that a dense search finds, in the order of the surface points; adds all tried poses to `counts`.
/// The gripper is turned about each closing axis in steps, starting at the first of `directions` that is across it.
ParallelGrasps parallel_grasps(const PartModel& part, const Gripper& gripper, double friction,
                               const std::vector<Vec3>& directions, GraspCounts& counts);

/// Callback that returns whether nothing obstructs the gripper at a pose in the model frame.
using IsClear = std::function<bool(const Pose& pose, const Aperture& at)>;

/// Presses the pads onto the part, near the aperture `guess`; the closing axis is x of the pose. Returns none, and
/// counts why, if the pads do not hold the part or if `is_clear` returns false where they touch it.
std::optional<Grasp> close_fingers(const PartModel& part, const Gripper& gripper, double friction, const Pose& pose,
                                   const Aperture& guess, GraspCounts& counts, const IsClear& is_clear = {});

/// Returns whether the gripper collides with the part itself while it approaches or closes. Pads that touch the part do
/// not count as colliding.
bool goes_through(const PartModel& part, const Gripper& gripper, const Grasp& grasp);

}  // namespace bin_scenes
