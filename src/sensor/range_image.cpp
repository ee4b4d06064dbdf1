#include "bin_scenes/sensor/range_image.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, 3> no_vector = {no_value, no_value, no_value};

std::array<float, 3> on_ray(const RangeImage& image, const Lens& lens, std::size_t column, std::size_t row) {
  const double z = image.depth[row * static_cast<std::size_t>(image.width) + column];
  const Vec3 ray = lens.ray(static_cast<double>(column), static_cast<double>(row));
  return {static_cast<float>(ray.x() * z), static_cast<float>(ray.y() * z), static_cast<float>(z)};
}

/// Of a plane n . p = d through neighbouring points, seen from the origin in directions (x, y, 1): 1 / z is linear in x
/// and y there, with n / d as coefficients. Least squares of 1 / z spread an error of depth along the rays, as it is.
std::array<float, 3> fitted_normal(const std::vector<std::array<float, 3>>& points, std::size_t width,
                                   std::size_t height, std::size_t column, std::size_t row) {
  constexpr std::size_t reach = 2;  // pixels to each side
  constexpr double steepest = 3.0;  // depth over lateral distance, 72 degrees: what is steeper is another surface
  const auto seen = [&](std::size_t at) {
    const double z = points[at][2];
    return Vec3(points[at][0] / z, points[at][1] / z, 1.0 / z);
  };
  const Vec3 center = seen(row * width + column);
  if (!center.allFinite()) return no_vector;
  double n = 0.0, x = 0.0, y = 0.0, q = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, xq = 0.0, yq = 0.0;
  for (std::size_t r = row - std::min(reach, row); r <= std::min(row + reach, height - 1); ++r) {
    for (std::size_t c = column - std::min(reach, column); c <= std::min(column + reach, width - 1); ++c) {
      const std::size_t at = r * width + c;
      if (std::isnan(points[at][2])) continue;
      const Vec3 d = seen(at) - center;
      // |dz| / z0 is |dq| / q, and lateral distance / z0 is that of the directions.
      const double rise = d.z() / (d.z() + center.z());
      if (!(rise * rise <= steepest * steepest * (d.x() * d.x() + d.y() * d.y()))) continue;
      n += 1.0, x += d.x(), y += d.y(), q += d.z();
      xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y(), xq += d.x() * d.z(), yq += d.y() * d.z();
    }
  }
  xx -= x * x / n, xy -= x * y / n, yy -= y * y / n, xq -= x * q / n, yq -= y * q / n;
  const double determinant = xx * yy - xy * xy;
  constexpr double flat = 1e-6;  // of the spread of directions: points on a line
  if (!(n >= 3.0 && determinant > flat * (xx + yy) * (xx + yy))) return no_vector;
  const double a = (yy * xq - xy * yq) / determinant, b = (xx * yq - xy * xq) / determinant;
  const double at_axis = center.z() + q / n - a * (center.x() + x / n) - b * (center.y() + y / n);
  const Vec3 normal = -Vec3(a, b, at_axis).normalized();  // n . p = 1 beyond the plane, seen from the camera
  return {static_cast<float>(normal.x()), static_cast<float>(normal.y()), static_cast<float>(normal.z())};
}

}  // namespace

std::vector<std::array<float, 3>> points_of(const RangeImage& image) {
  if (!image.points.empty()) return image.points;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  BIN_SCENES_ASSERT(image.depth.size() == width * height);
  std::vector<std::array<float, 3>> points(width * height);
  const Lens lens = lens_of(image.sensor);
  in_parallel(height, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      points[row * width + column] = on_ray(image, lens, column, row);
    }
  });
  return points;
}

std::vector<std::array<float, 3>> normals_of(const RangeImage& image, const std::vector<std::array<float, 3>>& points) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  BIN_SCENES_ASSERT(points.size() == width * height);
  std::vector<std::array<float, 3>> normals(points.size(), no_vector);
  const bool exact = sensor_model(image.sensor.model).exact;
  in_parallel(height, [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      if (std::isnan(points[i][2])) continue;
      normals[i] = exact ? image.normal[i] : fitted_normal(points, width, height, i - row * width, row);
    }
  });
  return normals;
}

}  // namespace bin_scenes
