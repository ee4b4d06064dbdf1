#include "light/tabletop.hpp"

#include "bin_scenes/core/random.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// Smooth noise between -1 and 1 over the plane (Perlin 1985, "An image synthesizer", of values).
double patches(double x, double y, const Random& key) {
  const auto at = [&](double column, double row) {
    return key.of_piece(static_cast<std::uint64_t>(static_cast<std::int64_t>(column)))
        .of_piece(static_cast<std::uint64_t>(static_cast<std::int64_t>(row)))
        .uniform(-1.0, 1.0);
  };
  const double column = std::floor(x), row = std::floor(y);
  const auto eased = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = eased(x - column), v = eased(y - row);
  const double upper = (1.0 - u) * at(column, row) + u * at(column + 1.0, row);
  const double lower = (1.0 - u) * at(column, row + 1.0) + u * at(column + 1.0, row + 1.0);
  return (1.0 - v) * upper + v * lower;
}

}  // namespace

Surface table_surface(const Table& table, const Vec3& point, std::uint64_t key) {
  Surface surface = table.surface;
  if (table.mottle <= 0.0) return surface;
  double sum = 0.0, weight = 0.57, size = table.patch;  // weights of four octaves, with a sum below 1.1
  for (std::uint64_t octave = 0; octave < 4; ++octave, weight *= 0.5, size *= 0.37)
    sum += weight * patches(point.x() / size, point.y() / size, Random(key, octave, Stream::sensor));
  surface.albedo = std::clamp(surface.albedo * (1.0 + table.mottle * std::clamp(sum, -1.0, 1.0)), 0.0, 1.0);
  return surface;
}

}  // namespace bin_scenes
