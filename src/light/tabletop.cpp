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

double distance_to_table(const Ray& ray, double height) {
  return (height - ray.origin.z()) / ray.direction.z();
}

}  // namespace

void Tabletop::cover(const Ray& ray, const Hit& nothing, Hit& hit) const {
  const double distance = distance_to_table(ray, settings_.height);
  if (!there() || !(distance >= ray.near && distance <= ray.far) || distance >= hit.distance) return;
  hit = nothing;
  hit.distance = distance;
  hit.normal = ray.direction.z() < 0.0 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ());
  hit.line = line;
}

bool Tabletop::blocks(const Ray& ray) const {
  const double distance = distance_to_table(ray, settings_.height);
  return there() && distance >= ray.near && distance <= ray.far;
}

Surface Tabletop::surface(const Vec3& point) const {
  Surface surface;
  surface.albedo = settings_.albedo;
  surface.gloss = settings_.gloss;
  surface.roughness = settings_.roughness;
  if (settings_.mottle <= 0.0) return surface;
  double sum = 0.0, weight = 0.57, size = settings_.patch;  // weights of four octaves, with a sum below 1.1
  for (std::uint64_t octave = 0; octave < 4; ++octave, weight *= 0.5, size *= 0.37)
    sum += weight * patches(point.x() / size, point.y() / size, Random(key_, octave, Stream::sensor));
  surface.albedo = std::clamp(surface.albedo * (1.0 + settings_.mottle * std::clamp(sum, -1.0, 1.0)), 0.0, 1.0);
  return surface;
}

}  // namespace bin_scenes
