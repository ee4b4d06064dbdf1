/// Proposes axes about which a part may be symmetric. symmetry.cpp tests them.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <vector>

namespace bin_scenes {

/// Axes of inertia; where two moments are equal the principal axes are no more special than others across the third,
/// and the shape itself has to decide.
std::vector<Vec3> candidate_axes(const PartModel& part);

}  // namespace bin_scenes
