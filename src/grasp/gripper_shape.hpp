/// A gripper as convex bodies in its own frame. reach.hpp tests these bodies, or the volumes that they sweep, against
/// the scene.
#pragma once

#include "bin_scenes/scene/gripper.hpp"
#include "grasp/sweep.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the boxes of the finger at +x in the gripper's frame, with its inner face in the plane x = 0: one box, or
/// those around a finger mesh. The other finger is the same, rotated by half a turn about z.
std::vector<Aabb> finger_of(const Gripper& gripper);
/// Returns the volume that the opened gripper sweeps during the last `back` (m) of its approach; if `back` is 0, the
/// gripper at the end of its approach. All volumes are grown by `margin` (m) on all sides.
std::vector<Sweep> approach_sweeps(const Gripper& gripper, const Aperture& at, double back, double margin);
/// Returns the volume that the fingers sweep while they close, or while they expand in a hole.
std::vector<Sweep> closing_sweeps(const Gripper& gripper, const Aperture& at, double margin);
/// Returns the volume of the gripper whose pads touch the part.
std::vector<Sweep> closed_shape(const Gripper& gripper, const Aperture& at, double margin);

}  // namespace bin_scenes
