/// Finds the places at which the surfaces of two placed meshes intersect, as short segments that two triangles share.
/// The measure of penetration starts from these segments. They are grouped by the closed curves that they form; the
/// depth of an overlap is not computed here.
#pragma once

#include "tree_pair.hpp"

#include <optional>

namespace bin_scenes {

/// The common segment of two triangles (frame of mesh a, m).
struct Crossing {
  Vec3 point;                                     ///< centre of the segment
  Aabb box;                                       ///< bounding box of the segment
  std::array<std::size_t, 2> triangles = {0, 0};  ///< indices of one triangle of a and one of b
};

/// Returns the common segment of two triangles; none if they are apart, or coplanar (then their neighbours intersect).
std::optional<Crossing> crossing(const Facet& s, const Facet& t, double tolerance);

/// Returns the crossings of all triangles of a with all triangles of b, in the frame of a; `b_in_a`: pose of b there.
std::vector<Crossing> crossings(const MeshQuery& a, const MeshQuery& b, const Pose& b_in_a, double tolerance);

/// Returns groups of crossings whose boxes touch, as ascending indices: one group per closed curve of intersection.
std::vector<std::vector<std::size_t>> connected(const std::vector<Crossing>& crossings, double tolerance);

}  // namespace bin_scenes
