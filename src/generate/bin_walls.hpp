/// Tests whether the mesh of a bin has walls that hold parts: walls with two sides, and not a single sheet of triangles
/// that parts could pass through. It only refuses such a bin, and changes nothing.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Throws an Error if the floor of a bin is a sheet of triangles without thickness: its distance field has no inside,
/// and parts would fall through. The solver bullet accepts it, because it collides with the triangles themselves.
void check_bin_walls(const PartModel& bin, const Request& request);

}  // namespace bin_scenes
