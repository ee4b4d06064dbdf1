/// One convex hull: from points to a mesh, and questions to it.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Closed convex mesh over the points, or an empty one where they span no volume. Above `max_vertices` it
/// shrinks a little: the vertex furthest outside is added until the count is reached.
Mesh convex_hull(const std::vector<Vec3>& points, int max_vertices);

/// Half-space normal . x <= offset; the normal points out of the solid.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;
  double above(const Vec3& x) const { return normal.dot(x) - offset; }
};

/// The half-spaces of a closed convex mesh.
class HullPlanes {
 public:
  explicit HullPlanes(const Mesh& hull);

  /// Largest normal . p - offset: negative inside; outside a lower bound of the distance.
  double outside(const Vec3& p) const;
  /// Whether that is more than `limit`: mostly the first planes tell.
  bool outside_by_more(const Vec3& p, double limit) const;
  const Aabb& bounds() const { return bounds_; }
  /// Largest way out of the bounds along an axis: negative inside, outside a lower bound of the distance.
  double to_box(const Vec3& p) const { return (bounds_.lower - p).cwiseMax(p - bounds_.upper).maxCoeff(); }

 private:
  std::vector<Plane> planes_;
  Aabb bounds_;
};

/// How far a point lies outside all of the hulls: 0 inside of one, else a lower bound of the distance.
double distance_to_union(const std::vector<HullPlanes>& hulls, const Vec3& p);

}  // namespace bin_scenes
