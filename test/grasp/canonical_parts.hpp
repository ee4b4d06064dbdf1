/// Parts whose best grasp any engineer would name, m.
#pragma once

#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace bin_scenes::test {

/// A closed outline of (radius, z), counter-clockwise, turned about z.
inline Mesh revolved(const std::vector<std::pair<double, double>>& outline, std::uint32_t segments) {
  Mesh mesh;
  std::vector<std::uint32_t> first;
  for (const auto& [r, z] : outline) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    for (std::uint32_t k = 0; k < (r > 0.0 ? segments : 1); ++k) {
      const double angle = 2.0 * M_PI * k / segments;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const auto at = [&](std::size_t i, std::uint32_t k) {
    return first[i] + (outline[i].first > 0.0 ? k % segments : 0);
  };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t j = (i + 1) % outline.size();
    for (std::uint32_t k = 0; k < segments; ++k) {
      const std::uint32_t a = at(i, k), b = at(i, k + 1), c = at(j, k + 1), d = at(j, k);
      if (a != b) mesh.triangles.push_back({a, b, c});
      if (c != d) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

/// Shaft of 8 x 30 mm along -z, head of 13 x 5.3 mm along z.
inline Mesh bolt_mesh() {
  return revolved({{0, -0.030}, {0.004, -0.030}, {0.004, 0}, {0.0065, 0}, {0.0065, 0.0053}, {0, 0.0053}}, 24);
}

/// Open towards z, about its centre.
inline Mesh cup_mesh(double radius, double height, double wall) {
  const double h = 0.5 * height;
  return revolved({{0, -h}, {radius, -h}, {radius, h}, {radius - wall, h}, {radius - wall, wall - h}, {0, wall - h}},
                  32);
}

/// The letter J from bars of 6 x 6 mm, 24 x 40 mm, in the x-y plane.
inline Mesh hook_mesh() {
  constexpr double w = 0.006, across = 0.024, small = 0.016, tall = 0.040;
  return prism({{0, 0},
                {w, 0},
                {across - w, 0},
                {across, 0},
                {across, w},
                {across, small},
                {across - w, small},
                {across - w, w},
                {w, w},
                {w, tall},
                {0, tall},
                {0, w}},
               {{0, 1, 8, 11}, {1, 2, 7, 8}, {2, 3, 4, 7}, {4, 5, 6, 7}, {8, 9, 10, 11}}, w)
      .mesh;
}

}  // namespace bin_scenes::test
