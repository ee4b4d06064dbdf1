/// Cuts a solid by planes into pieces that are nearly convex. convex_hulls.cpp encloses each piece in a hull.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace bin_scenes {

/// Points with normal . p > offset lie above.
struct CutPlane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;

  double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// The triangles of a surface below and above a plane, those across it clipped. Vertices within `tolerance` of the
/// plane count as in it; a triangle wholly in it goes to the side of its solid: below, if it looks up. No caps are
/// made: the corners of a cut solid all lie on its clipped surface, but for those where three cuts meet inside it.
std::pair<Mesh, Mesh> clip(const Mesh& surface, const CutPlane& plane, double tolerance);

/// The data of the solid that the cuts need.
struct SolidMeasure {
  /// The largest distance (m) by which a convex hull extends beyond the solid, and the point with this distance.
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
