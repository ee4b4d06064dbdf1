/// A gripper as convex bodies in its own frame. reach.hpp tests these bodies, or the volumes that they sweep, against
/// the scene.
#pragma once

#include "bin_scenes/scene/gripper.hpp"
#include "grasp/sweep.hpp"

#include <vector>

namespace bin_scenes {

/// Boxes of the finger at +x in the gripper's frame, with its inner face in the plane x = 0; the other finger is the
/// same, turned by half about z. One box, or those around a finger mesh.
std::vector<Aabb> finger_of(const Gripper& gripper);
/// The volume that the opened gripper sweeps while it approaches over the distance `back` (m); with `back` 0, the
/// gripper at the end of its approach. Grown by `margin` (m) on all sides.
std::vector<Sweep> approach_sweeps(const Gripper& gripper, const Aperture& at, double back, double margin);
/// The volume that its fingers sweep while they close, or expand in a hole.
std::vector<Sweep> closing_sweeps(const Gripper& gripper, const Aperture& at, double margin);
/// The gripper with its pads on the part.
std::vector<Sweep> closed_shape(const Gripper& gripper, const Aperture& at, double margin);

}  // namespace bin_scenes
