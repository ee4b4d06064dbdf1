/// Divides the surface of a mesh into patches by HACD, fine enough to be merged into convex pieces by convex_hulls.cpp.
/// No other file includes HACD's headers.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Vertices of about `count` patches of neighbouring triangles, each a point set for a hull. HACD takes time that grows
/// with the square of the triangles and wants one connected mesh, so it gets every shell by itself, cut and thinned to
/// a bounded number of triangles; the patches it finds are given back with all original vertices. Walls of closed
/// cavities are left out: nothing reaches them.
std::vector<std::vector<Vec3>> hacd_patches(const Mesh& mesh, int count);

}  // namespace bin_scenes
