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

/// Prism over a regular polygon, about z.
inline Mesh prism_mesh(double radius, double height, int sides) {
  Mesh mesh;
  for (const double z : {-0.5 * height, 0.5 * height}) {
    for (int i = 0; i < sides; ++i) {
      const double u = 2 * M_PI * i / sides;
      mesh.vertices.push_back({radius * std::cos(u), radius * std::sin(u), z});
    }
  }
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
    if (i > 0 && i + 1 < n) {
      mesh.triangles.push_back({0, j, i});
      mesh.triangles.push_back({n, n + i, n + j});
    }
  }
  return mesh;
}

inline double surface_area(const Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += 0.5 * mesh.area_vector(t).norm();
  return area;
}

/// Uniform random points on the surface.
inline std::vector<Vec3> random_surface_points(const Mesh& mesh, int count, std::uint64_t seed) {
  std::vector<double> sums{0.0};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sums.push_back(sums.back() + mesh.area_vector(t).norm());
  Random random(seed, 0, Stream::probe);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double at = random.uniform(0, sums.back());
    const auto t = std::min<std::size_t>(mesh.triangles.size() - 1,
                                         std::upper_bound(sums.begin(), sums.end(), at) - sums.begin() - 1);
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& [a, b, c] = mesh.triangles[t];
    points.push_back(mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a]) +
                     v * (mesh.vertices[c] - mesh.vertices[a]));
  }
  return points;
}

}  // namespace bin_scenes::test
