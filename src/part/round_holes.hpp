/// Round holes of a mesh, and convex hulls that stay out of them. convex_hulls.cpp uses both.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <vector>

namespace bin_scenes {

/// A cylinder without material, inside a wall of facets.
struct RoundHole {
  Vec3 center, axis;  ///< a point of the axis (m), and the direction of the axis
  double radius;      ///< m, radius of the largest cylinder that touches no facet
  double low, high;   ///< m along the axis from `center`: where the wall begins and ends
};

/// Returns the holes, through or blind, whose walls are facets all around one axis, at least six and equally far from
/// it. Threads and holes with a curved profile are not returned.
std::vector<RoundHole> round_holes(const MeshQuery& query);

/// Removes from hulls what is inside a hole, by planes that touch its cylinder. A hull that surrounds more of the hole
/// than one plane can follow to within `loss` (m) is cut into sectors first. The bottom of a blind hole stays.
std::vector<Mesh> cleared(std::vector<Mesh> hulls, const RoundHole& hole, double loss);

}  // namespace bin_scenes
