/// One convex hull: from points to a mesh, and distances to it.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Closed convex mesh over the points, or an empty one if they span no volume. If more than `max_vertices`
/// are needed, the hull is slightly too small: the point farthest outside is added until the number is reached.
Mesh convex_hull(const std::vector<Vec3>& points, int max_vertices);

/// A small subset of the points that reaches as far as all of them in each direction (to 1e-9 of the diagonal).
std::vector<Vec3> extreme_points(const std::vector<Vec3>& points);

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
  /// Whether distance() exceeds `limit`; usually decided by the first planes.
  bool outside_by_more(const Vec3& p, double limit) const;
  const Aabb& bounds() const { return bounds_; }
  std::size_t count() const { return planes_.size(); }
  /// Largest distance to the bounding box along an axis: negative inside, outside a lower bound of the distance.
  double to_box(const Vec3& p) const { return (bounds_.lower - p).cwiseMax(p - bounds_.upper).maxCoeff(); }

 private:
  std::vector<Plane> planes_;
  Aabb bounds_;
};

/// Distance of a point from the union of the hulls: 0 inside any of them, otherwise a lower bound.
double distance_to_union(const std::vector<HullPlanes>& hulls, const Vec3& p);

}  // namespace bin_scenes
