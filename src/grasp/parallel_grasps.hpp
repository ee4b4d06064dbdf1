/// Poses of a two-finger gripper whose pads meet the part from opposite sides, or two walls of a hole from within.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"

namespace bin_scenes {

struct ParallelGrasps {
  std::vector<Grasp> grasps;
  std::vector<ClosingAxis> axes;  ///< of the pairs of points that have one
};

/// Densely, in the order of the surface's points; counts all that was tried. The gripper is turned about each closing
/// axis in steps from the first of `directions` across it.
ParallelGrasps parallel_grasps(const PartModel& part, const Gripper& gripper, double friction,
                               const std::vector<Vec3>& directions, GraspCounts& counts);

/// The pads pressed onto the part from about the distance `guess`, with the closing axis along x of the pose. None, and
/// counted, if they do not hold it.
std::optional<Grasp> close_fingers(const PartModel& part, const Gripper& gripper, double friction, const Pose& pose,
                                   const Aperture& guess, GraspCounts& counts);

/// Whether the gripper meets the part itself as it comes or closes. The pads touch it, which is none.
bool goes_through(const PartModel& part, const Gripper& gripper, const Grasp& grasp);

}  // namespace bin_scenes
