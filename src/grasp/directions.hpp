/// Directions that the shape of a part suggests: grippers are turned to them.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/part/symmetry.hpp"

#include <vector>

namespace bin_scenes {

/// Unit directions in the model frame, the most important first: axes of symmetry, normals of large flat faces, sharp
/// straight edges, and the principal axes last.
std::vector<Vec3> shape_directions(const PartModel& part, const Symmetries& symmetries);

/// Of the directions, the first that is across `axis` within a few degrees, projected across it; without one, the
/// projection of the first that is not along the axis. Unit.
Vec3 direction_across(const std::vector<Vec3>& directions, const Vec3& axis);

}  // namespace bin_scenes
