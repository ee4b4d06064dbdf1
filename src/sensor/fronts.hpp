/// Whether the back of a triangle of a mesh is ever seen from outside.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

namespace bin_scenes {

/// Each shell is closed and its triangles face outward: where a ray from outside meets the mesh first, it meets a
/// front. The fronts cover whatever the mesh covers.
bool shows_fronts_only(const Mesh& mesh);

}  // namespace bin_scenes
