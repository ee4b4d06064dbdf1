/// A gripper as convex bodies in its own frame.
#pragma once

#include "bin_scenes/scene/gripper.hpp"
#include "grasp/sweep.hpp"

#include <vector>

namespace bin_scenes {

/// What the gripper fills at the end of its approach, opened, and moved backwards by `back` (m) as well: what it
/// sweeps coming in. Grown by `margin` all around.
std::vector<Sweep> approach_sweeps(const Gripper& gripper, const Aperture& at, double back, double margin);
/// What its fingers sweep when they close, or expand.
std::vector<Sweep> closing_sweeps(const Gripper& gripper, const Aperture& at, double margin);
/// What it fills when its pads touch the part.
std::vector<Sweep> closed_shape(const Gripper& gripper, const Aperture& at, double margin);

}  // namespace bin_scenes
