/// Tests whether the mesh of a bin has walls that hold parts: walls with two sides, and not a single sheet of triangles
/// that parts could pass through. It only refuses such a bin, and changes nothing.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Refuses a bin whose floor is a sheet of triangles without thickness: a distance field knows no inside of it, and
/// parts fall through. Bullet collides with the triangles themselves and needs none.
void check_bin_walls(const PartModel& bin, const Request& request);

}  // namespace bin_scenes
