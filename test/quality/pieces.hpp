/// Bodies known twice: as a closed mesh and as the convex pieces it is the union of.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/mesh/mesh.hpp"

#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace bin_scenes::test {

struct Body {
  Mesh mesh;
  std::vector<std::vector<Vec3>> pieces;  ///< corners of convex polyhedra
};

/// Prism over a plane figure made of convex polygons that share whole edges, centred in z. Its convex pieces
/// are the polygons, or what `pieces` names: the larger and the more they overlap, the nearer to the whole body.
inline Body prism(const std::vector<std::array<double, 2>>& corners, const std::vector<std::vector<int>>& polygons,
                  double height, const std::vector<std::vector<int>>& pieces = {}) {
  Body body;
  const auto count = static_cast<std::uint32_t>(corners.size());
  for (const double z : {-0.5 * height, 0.5 * height}) {
    for (const auto& [x, y] : corners) body.mesh.vertices.emplace_back(x, y, z);
  }
  for (const std::vector<int>& piece : pieces.empty() ? polygons : pieces) {
    body.pieces.emplace_back();
    for (const int i : piece) {
      body.pieces.back().push_back(body.mesh.vertices[i]);
      body.pieces.back().push_back(body.mesh.vertices[i + count]);
    }
  }
  std::set<std::pair<int, int>> sides;
  for (const std::vector<int>& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      sides.insert({polygon[i], polygon[(i + 1) % polygon.size()]});
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const auto a = static_cast<std::uint32_t>(polygon[0]), b = static_cast<std::uint32_t>(polygon[i - 1]),
                 c = static_cast<std::uint32_t>(polygon[i]);
      body.mesh.triangles.push_back({a, c, b});
      body.mesh.triangles.push_back({a + count, b + count, c + count});
    }
  }
  for (const auto& [i, j] : sides) {
    if (sides.count({j, i})) continue;
    const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>(j);
    body.mesh.triangles.push_back({a, b, b + count});
    body.mesh.triangles.push_back({a, b + count, a + count});
  }
  return body;
}

inline Body bar(const Vec3& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y();
  return prism({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, {{0, 1, 2, 3}}, size.z());
}

/// Two arms of unit length and width w, at right angles.
inline Body angle(double w, double height) {
  return prism({{0, 0}, {w, 0}, {1, 0}, {1, w}, {w, w}, {w, 1}, {0, 1}, {0, w}},
               {{0, 1, 4, 7}, {1, 2, 3, 4}, {7, 4, 5, 6}}, height, {{0, 2, 3, 7}, {0, 1, 5, 6}});
}

/// Three bars of width w in the shape of a U.
inline Body channel(double w, double height) {
  return prism(
      {{0, 0}, {w, 0}, {1 - w, 0}, {1, 0}, {1, w}, {1, 1}, {1 - w, 1}, {1 - w, w}, {w, w}, {w, 1}, {0, 1}, {0, w}},
      {{0, 1, 8, 11}, {1, 2, 7, 8}, {2, 3, 4, 7}, {4, 5, 6, 7}, {8, 9, 10, 11}}, height,
      {{0, 3, 4, 11}, {0, 1, 9, 10}, {2, 3, 5, 6}});
}

inline Body ring(double outer, double inner, double height, int segments) {
  std::vector<std::array<double, 2>> corners;
  std::vector<std::vector<int>> polygons;
  for (int i = 0; i < segments; ++i) {
    const double u = 2.0 * M_PI * i / segments;
    corners.push_back({inner * std::cos(u), inner * std::sin(u)});
    corners.push_back({outer * std::cos(u), outer * std::sin(u)});
    const int j = (i + 1) % segments;
    polygons.push_back({2 * i, 2 * i + 1, 2 * j + 1, 2 * j});
  }
  return prism(corners, polygons, height);
}

}  // namespace bin_scenes::test
