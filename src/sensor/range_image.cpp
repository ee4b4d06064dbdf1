#include "bin_scenes/sensor/range_image.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "core/in_parallel.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

std::array<float, 3> on_ray(const RangeImage& image, const Lens& lens, std::size_t column, std::size_t row) {
  const double z = image.depth[row * static_cast<std::size_t>(image.width) + column];
  const Vec3 ray = lens.ray(static_cast<double>(column), static_cast<double>(row));
  return {static_cast<float>(ray.x() * z), static_cast<float>(ray.y() * z), static_cast<float>(z)};
}

}  // namespace

std::array<float, 3> normal_at(const RangeImage& image, std::size_t pixel) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  return std::isnan(image.depth[pixel]) ? std::array<float, 3>{nan, nan, nan} : image.normal[pixel];
}

std::array<float, 3> point_at(const RangeImage& image, int column, int row) {
  const auto x = static_cast<std::size_t>(column), y = static_cast<std::size_t>(row);
  if (!image.points.empty()) return image.points[y * static_cast<std::size_t>(image.width) + x];
  return on_ray(image, lens_of(image.sensor), x, y);
}

std::vector<std::array<float, 3>> points_of(const RangeImage& image) {
  if (!image.points.empty()) return image.points;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<std::array<float, 3>> points(width * height);
  const Lens lens = lens_of(image.sensor);
  in_parallel(height, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      points[row * width + column] = on_ray(image, lens, column, row);
    }
  });
  return points;
}

}  // namespace bin_scenes
