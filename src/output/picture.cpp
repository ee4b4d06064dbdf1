#include "output/png.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "scene/palette.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

using Colour = Eigen::Array3d;

constexpr double outline = 0.35;       ///< brightness left on the line between two parts
constexpr double hollow_color = 0.65;  ///< how much of its light a hollow may lose
constexpr int neighbourhood = 10;      ///< pixels around one that decide whether it lies in a hollow

/// Mean depth around each pixel, by a summed-area table (Crow 1984); unseen pixels do not count.
std::vector<double> mean_depth(const RangeImage& image) {
  const int width = image.width, height = image.height;
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * (width + 1) + x; };
  struct Sum {
    double depth = 0.0, count = 0.0;
  };
  std::vector<Sum> sum(static_cast<std::size_t>(width + 1) * (height + 1));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float z = image.depth[static_cast<std::size_t>(y) * width + x];
      const bool seen = std::isfinite(z);
      const Sum &left = sum[at(x, y + 1)], &above = sum[at(x + 1, y)], &corner = sum[at(x, y)];
      sum[at(x + 1, y + 1)] = {(seen ? z : 0.0) + left.depth + above.depth - corner.depth,
                               seen + left.count + above.count - corner.count};
    }
  }
  std::vector<double> mean(image.depth.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int x0 = std::max(0, x - neighbourhood), x1 = std::min(width, x + neighbourhood + 1);
      const int y0 = std::max(0, y - neighbourhood), y1 = std::min(height, y + neighbourhood + 1);
      const Sum &last = sum[at(x1, y1)], &left = sum[at(x0, y1)], &above = sum[at(x1, y0)], &corner = sum[at(x0, y0)];
      mean[static_cast<std::size_t>(y) * width + x] =
          (last.depth - left.depth - above.depth + corner.depth) /
          std::max(1.0, last.count - left.count - above.count + corner.count);
    }
  }
  return mean;
}

}  // namespace

std::vector<std::uint8_t> shaded_picture(const RangeImage& image) {
  const int width = image.width, height = image.height;
  BIN_SCENES_ASSERT(image.depth.size() == static_cast<std::size_t>(width) * height);
  BIN_SCENES_ASSERT(image.label.size() == image.depth.size() && image.normal.size() == image.depth.size());
  const Colour sky(0.97, 0.97, 0.98), bin(0.80, 0.82, 0.85);
  const Vec3 light = Vec3(-0.45, -0.65, -1.0).normalized();  // optical frame: left, up, towards the camera

  float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
  for (const float z : image.depth) {
    if (std::isfinite(z)) nearest = std::min(nearest, z), farthest = std::max(farthest, z);
  }
  // Depth darkening (Luft, Colditz, Deussen 2006, "Image enhancement by unsharp masking the depth buffer").
  const std::vector<double> mean = mean_depth(image);
  const double hollow = std::max(1e-6, 0.12 * static_cast<double>(farthest - nearest));

  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * image.depth.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      Colour colour = sky;
      if (std::isfinite(image.depth[i])) {
        const auto& n = image.normal[i];
        const double lit = std::max(0.0, Vec3(n[0], n[1], n[2]).dot(light));
        const double below = std::clamp((image.depth[i] - mean[i]) / hollow, 0.0, 1.0);
        colour = image.label[i] ? Colour(part_colour(image.label[i] - 1)) : bin;
        colour *= (0.30 + 0.75 * (std::isfinite(lit) ? lit : 0.0)) * (1.0 - hollow_color * below);
      }
      const bool right = x + 1 < width && image.label[i + 1] != image.label[i];
      const bool down = y + 1 < height && image.label[i + width] != image.label[i];
      if (right || down) colour *= outline;
      for (int c = 0; c < 3; ++c) {
        rgb.push_back(static_cast<std::uint8_t>(255.0 * std::clamp(colour[c], 0.0, 1.0) + 0.5));
      }
    }
  }
  return rgb;
}

}  // namespace bin_scenes
