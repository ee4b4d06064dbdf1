/// Proposes axes about which a part may be symmetric. symmetry.cpp tests them.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the principal axes and the model axes. If two moments of inertia are equal, the principal axes perpendicular
/// to the third one are arbitrary, and axes that the shape suggests are added.
std::vector<Vec3> candidate_axes(const PartModel& part);

}  // namespace bin_scenes
