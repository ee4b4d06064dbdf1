/// Geometry of one convex hull: its construction from points, and distances to it. convex_hulls.hpp composes a part of
/// several hulls.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the closed convex hull of the points, or an empty mesh if they span no volume. If more than `max_vertices`
/// vertices would be needed, the hull is slightly too small: the points that are farthest outside are added until the
/// number is reached.
Mesh convex_hull(const std::vector<Vec3>& points, int max_vertices);

/// Returns a small subset of the points that extends as far as all points in every direction, within 1e-9 of the
/// diagonal.
std::vector<Vec3> extreme_points(const std::vector<Vec3>& points);

/// The half-space normal . x <= offset. The normal points out of the solid.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;
  double above(const Vec3& x) const { return normal.dot(x) - offset; }
};

/// The half-spaces of a closed convex mesh, for distance tests.
class HullPlanes {
 public:
  explicit HullPlanes(const Mesh& hull);

  /// Returns the largest normal . p - offset (m). It is negative inside; outside it is a lower bound of the distance.
  double outside(const Vec3& p) const;
  /// Whether outside() exceeds `limit` (m). The first planes usually decide it.
  bool outside_by_more(const Vec3& p, double limit) const;
  const Aabb& bounds() const { return bounds_; }
  std::size_t count() const { return planes_.size(); }
  /// Returns the largest distance to the bounding box along an axis (m): negative inside; outside a lower bound of the
  /// distance.
  double to_box(const Vec3& p) const { return (bounds_.lower - p).cwiseMax(p - bounds_.upper).maxCoeff(); }

 private:
  std::vector<Plane> planes_;
  Aabb bounds_;
};

/// Returns the distance of a point from the union of the hulls (m): 0 inside any of them, otherwise a lower bound.
double distance_to_union(const std::vector<HullPlanes>& hulls, const Vec3& p);

}  // namespace bin_scenes
