/// Determines whether the back of any triangle of a mesh can be seen from outside. If not, views need to draw front
/// sides only.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Each shell is closed and its triangles face outward: where a ray from outside meets the mesh first, it meets a
/// front. The fronts cover whatever the mesh covers.
bool shows_fronts_only(const Mesh& mesh);

/// Returns for each triangle whether the whole mesh is behind its plane, so that the mesh does not occlude it. For
/// meshes with many corners, the result may be false although this is the case.
std::vector<char> outermost_triangles(const Mesh& mesh);

}  // namespace bin_scenes
