/// Divides the surface of a mesh into patches by HACD, fine enough to be merged into convex pieces by convex_hulls.cpp.
/// No other file includes HACD's headers.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the vertices of about `count` patches of neighbouring triangles, each as a set of points for a hull. The
/// time of HACD grows with the square of the number of triangles, and it requires a connected mesh. It therefore
/// processes each shell alone, cut and simplified to a limited number of triangles; the returned patches contain all
/// original vertices. Walls of closed cavities are left out, because nothing reaches them.
std::vector<std::vector<Vec3>> hacd_patches(const Mesh& mesh, int count);

}  // namespace bin_scenes
