/// Small convex polyhedra that are made by cutting a box with half-spaces, and the exact depth of overlap of two of
/// them. penetration.cpp divides concave meshes into such cells.
#pragma once

#include "bin_scenes/part/hull_geometry.hpp"

#include <utility>
#include <vector>

namespace bin_scenes {

class ConvexCell {
 public:
  explicit ConvexCell(const Aabb& box);

  /// Intersects the cell with the half-space. Lengths below 1e-10 of the box's diagonal count as zero.
  void clip(const Plane& plane);
  bool empty() const { return faces_.empty(); }

  struct Face {
    Plane plane;
    int first, count;  ///< range of its vertices in loops_, counter-clockwise seen from outside
  };
  struct Edge {
    int vertex, face[2];
    Vec3 fan;  ///< cross product of the two faces' normals, along the edge
  };
  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Face>& faces() const { return faces_; }
  /// Returns the edges of the faces for which `wanted` is not 0, and possibly further ones.
  std::vector<Edge> edges(const std::vector<char>& wanted) const;
  /// Returns the vertex with the smallest coordinate along `direction`.
  const Vec3& lowest(const Vec3& direction) const;

 private:
  struct Clipping;
  std::pair<bool, bool> measure_heights(const Plane& plane, Clipping& c) const;
  void add_cap(const Plane& plane, Clipping& c);

  double tolerance_;
  std::vector<Vec3> vertices_;
  std::vector<Face> faces_;
  std::vector<int> loops_;
};

/// The shortest translation that separates two convex bodies.
struct Separation {
  double depth = 0.0;             ///< m; <= 0: they are apart already
  Vec3 direction = Vec3::Zero();  ///< unit; moves b away from a
  Vec3 point = Vec3::Zero();      ///< the point where the bodies touch last, before b is moved
};

/// Returns the penetration depth of two convex cells, from the faces of both and the pairs of edges whose normal arcs
/// cross (Gregorius 2013, "The separating axis test between convex polyhedra"). `common`: a point in both, up to
/// `slack` (m); the depth along a feature's normal is at least its distance from the feature's plane, so that most
/// features need no test. Returns early with some depth <= `enough` (m) once it is known.
Separation separation(const ConvexCell& a, const ConvexCell& b, const Vec3& common, double slack, double enough);

}  // namespace bin_scenes
