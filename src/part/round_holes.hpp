/// Round holes of a mesh, and convex hulls that stay out of them. convex_hulls.cpp uses both.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <vector>

namespace bin_scenes {

/// A cylinder that is free of the solid, inside a wall of facets.
struct RoundHole {
  Vec3 center, axis;  ///< a point of the axis (m), and its direction
  double radius;      ///< m, of the largest cylinder that touches no facet
  double low, high;   ///< m along the axis from the centre: where the wall ends
};

/// Returns the holes, through or blind, whose walls are facets all around one axis, at least six and equally far from
/// it. Threads and holes with a curved profile are none.
std::vector<RoundHole> round_holes(const MeshQuery& query);

/// Cuts off what hulls have inside a hole, by planes that touch its cylinder. A hull that lies around more of the hole
/// than one plane can follow to within `loss` (m) is cut into sectors first. What closes a blind hole stays.
std::vector<Mesh> cleared(std::vector<Mesh> hulls, const RoundHole& hole, double loss);

}  // namespace bin_scenes
