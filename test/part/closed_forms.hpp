/// Exact distances to the meshes of shapes.hpp.
#pragma once

#include "part/shapes.hpp"

namespace bin_scenes::test {

/// Signed distance to a box with half sides `half` about the origin.
inline double box_distance(const Vec3& half, const Vec3& p) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// Signed distance to a torus about z.
inline double torus_distance(double ring, double tube, const Vec3& p) {
  return std::hypot(std::hypot(p.x(), p.y()) - ring, p.z()) - tube;
}

/// Both meshes as shells of one.
inline Mesh joined(Mesh mesh, const Mesh& other) {
  append(mesh, other);
  return mesh;
}

}  // namespace bin_scenes::test
