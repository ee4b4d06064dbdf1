/// Cuts a solid by planes into pieces that are nearly convex. convex_hulls.cpp encloses each piece in a hull.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace bin_scenes {

/// Points with normal . p > offset are above the plane.
struct CutPlane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;

  double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// Divides a surface at a plane. Returns the part below and the part above; triangles that cross the plane are clipped.
/// Vertices within `tolerance` of the plane are in it; a triangle in the plane belongs to the side of its solid: below,
/// if it faces up. No caps are made, because hulls need only the corners of the cut solid, and nearly all of them are
/// on the clipped surface.
std::pair<Mesh, Mesh> clip(const Mesh& surface, const CutPlane& plane, double tolerance);

/// The data of the solid that the cuts need.
struct SolidMeasure {
  /// Returns the largest distance (m) by which a convex hull extends beyond the solid, and the point at this distance.
  std::function<std::pair<double, Vec3>(const Mesh& hull)> protrusion;
  std::function<bool(const Vec3& point)> inside;
};

/// Returns the corners of the pieces, each as a set of points for a hull. The piece whose hull extends farthest beyond
/// the solid is cut next, until none extends by more than `limit` (m) or there are `max_pieces`. Among the planes
/// through concave edges of the piece and across its axes, the one is used after which the hulls of both sides enclose
/// the smallest volume. The result is exact for unions of convex solids that meet at concave edges. The idea is that of
/// approximate convex decomposition by cutting (Lien & Amato 2007, "Approximate convex decomposition of polyhedra"; Wei
/// et al. 2022, CoACD).
std::vector<std::vector<Vec3>> plane_cut_pieces(const Mesh& mesh, const SolidMeasure& measure, double limit,
                                                int max_pieces);

}  // namespace bin_scenes
