/// One convex hull: from points to a mesh, and questions to it.
#pragma once

#include "bin_scenes/scene/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// Closed convex mesh over the points, or an empty one where they span no volume. Above `max_vertices` the extreme
/// points in evenly spread directions are kept, so the hull shrinks a little.
Mesh convex_hull(const std::vector<Vec3>& points, int max_vertices);

/// The half-spaces of a closed convex mesh: normal . p <= offset inside.
class HullPlanes {
 public:
  explicit HullPlanes(const Mesh& hull);

  /// Largest normal . p - offset: negative inside; outside a lower bound of the distance.
  double outside(const Vec3& p) const;
  /// Inside, or on a face that looks against `normal` (m): a point with that normal is then no outer surface.
  bool covers(const Vec3& p, const Vec3& normal, double tolerance) const;
  const Aabb& bounds() const { return bounds_; }

 private:
  struct Plane {
    Vec3 normal;
    double offset;
  };
  std::vector<Plane> planes_;
  Aabb bounds_;
};

}  // namespace bin_scenes
