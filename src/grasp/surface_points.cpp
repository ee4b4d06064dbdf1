#include "grasp/surface_points.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

std::vector<SpreadPoint> spread_points(const Mesh& mesh, std::size_t count) {
  std::vector<double> sums(1, 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sums.push_back(sums.back() + mesh.area_vector(t).norm());
  std::vector<SpreadPoint> points;
  if (!(sums.back() > 0.0)) return points;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * sums.back();
    const auto found = std::upper_bound(sums.begin(), sums.end(), at);
    const auto t = std::min(mesh.triangles.size(), static_cast<std::size_t>(found - sums.begin())) - 1;
    // Roberts 2018, "The unreasonable effectiveness of quasirandom sequences": powers of the plastic number.
    double u = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(i + 1), 1.0);
    double v = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(i + 1), 1.0);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 &x = mesh.vertices[a], &y = mesh.vertices[b], &z = mesh.vertices[c];
    points.push_back({x + u * (y - x) + v * (z - x), mesh.area_vector(t).normalized()});
  }
  return points;
}

}  // namespace bin_scenes
