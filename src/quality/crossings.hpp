/// Finds the places at which the surfaces of two placed meshes intersect, as short segments that two triangles share.
/// The measure of penetration starts from these segments. They are grouped by the closed curves that they form; the
/// depth of an overlap is not computed here.
#pragma once

#include "tree_pair.hpp"

#include <optional>

namespace bin_scenes {

/// The common segment of two triangles.
struct Crossing {
  Vec3 point;                                     ///< centre of the crossing
  Aabb box;                                       ///< around it
  std::array<std::size_t, 2> triangles = {0, 0};  ///< one triangle of a and one of b
};

/// Returns none if the triangles do not intersect, or are coplanar; their neighbours intersect then instead.
std::optional<Crossing> crossing(const Facet& s, const Facet& t, double tolerance);

/// Crossings of all triangles of a with all triangles of b, in the frame of a; `b_in_a` takes b's frame to a's.
std::vector<Crossing> crossings(const MeshQuery& a, const MeshQuery& b, const Pose& b_in_a, double tolerance);

/// Groups of crossings whose boxes touch, each in order: one group per closed curve of intersection.
std::vector<std::vector<std::size_t>> connected(const std::vector<Crossing>& crossings, double tolerance);

}  // namespace bin_scenes
