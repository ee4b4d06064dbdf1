/// Determines whether the back of any triangle of a mesh can be seen from outside. If not, views need to draw front
/// sides only.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Returns whether only front sides are visible from outside: every shell is closed and its triangles face outward, so
/// that a ray from outside first hits a front side. Front sides then cover the whole silhouette.
bool shows_fronts_only(const Mesh& mesh);

/// Returns for each triangle whether the whole mesh is behind its plane, so that the mesh does not occlude it. For
/// meshes with many corners, the result may be false although this is the case.
std::vector<char> outermost_triangles(const Mesh& mesh);

}  // namespace bin_scenes
