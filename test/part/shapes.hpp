/// Meshes with known volume, inertia and distance, for tests of part/ and scene/.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/mesh/mesh.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace bin_scenes::test {

inline void append(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + base, b + base, c + base});
}

inline Mesh inverted(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline Mesh moved(Mesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

/// Box with sides `size` about `center`; vertex i has coordinate bits x, y, z = i & 1, i & 2, i & 4.
inline Mesh box_mesh(const Vec3& size, const Vec3& center = Vec3::Zero()) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    mesh.vertices.push_back(center + sign.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Corner tetrahedron (0, x, y, z).
inline Mesh corner_tetrahedron(double x, double y, double z) {
  Mesh mesh;
  mesh.vertices = {Vec3::Zero(), Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z)};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// Sphere from a tetrahedron-free start: an octahedron split `levels` times, vertices on the sphere.
inline Mesh sphere_mesh(double radius, int levels) {
  Mesh mesh;
  mesh.vertices = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (Vec3& v : mesh.vertices) v *= radius;
  return mesh;
}

/// Torus about z: radius of the ring, radius of the tube, segments around each.
inline Mesh torus_mesh(double ring, double tube, int around, int across) {
  Mesh mesh;
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2.0 * M_PI * i / around, v = 2.0 * M_PI * j / across;
      const double r = ring + tube * std::cos(v);
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return mesh;
}

/// L-shaped prism: the square [0,2]^2 less [1,2]^2, from z = 0 to `height`. Volume 3 height.
inline Mesh l_mesh(double height) {
  const double xs[] = {0, 2, 2, 1, 1, 0}, ys[] = {0, 0, 1, 1, 2, 2};
  Mesh mesh;
  for (const double z : {0.0, height}) {
    for (int i = 0; i < 6; ++i) mesh.vertices.push_back({xs[i], ys[i], z});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}, Triangle{0, 4, 5}}) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  return mesh;
}

/// Triangles strewn over the unit cube, sizes from slivers to large.
inline Mesh random_soup(std::size_t count, std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  const auto point = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()); };
  Mesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec3 center = point();
    const double size = std::pow(10.0, random.uniform(-4.0, -0.3));
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(center + size * (point() - Vec3::Constant(0.5)));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

}  // namespace bin_scenes::test
