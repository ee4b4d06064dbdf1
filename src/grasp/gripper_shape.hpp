/// A gripper as convex bodies in its own frame.
#pragma once

#include "bin_scenes/scene/gripper.hpp"
#include "grasp/sweep.hpp"

#include <vector>

namespace bin_scenes {

/// The volume that the opened gripper sweeps while it approaches over the distance `back` (m); with `back` 0, the
/// gripper at the end of its approach. Grown by `margin` (m) on all sides.
std::vector<Sweep> approach_sweeps(const Gripper& gripper, const Aperture& at, double back, double margin);
/// The volume that its fingers sweep while they close, or expand in a hole.
std::vector<Sweep> closing_sweeps(const Gripper& gripper, const Aperture& at, double margin);
/// The gripper with its pads on the part.
std::vector<Sweep> closed_shape(const Gripper& gripper, const Aperture& at, double margin);

}  // namespace bin_scenes
