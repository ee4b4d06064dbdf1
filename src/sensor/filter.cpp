#include "bin_scenes/sensor/filter.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/in_parallel.hpp"
#include "sensor/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

void take_away(RangeImage& image, std::size_t pixel, Validity code) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  image.validity[pixel] = static_cast<std::uint8_t>(code);
  image.depth[pixel] = nan;
  image.label[pixel] = 0;
  image.snr[pixel] = 0.0f;
  if (!image.points.empty()) image.points[pixel] = {nan, nan, nan};
}

/// Pixels of the window that have nearly the depth of its centre, which does not count.
int neighbours_of(const RangeImage& image, int column, int row, const OutlierFilter& settings) {
  const int reach = settings.window / 2;
  const auto depth = [&](int x, int y) { return image.depth[static_cast<std::size_t>(y) * image.width + x]; };
  const float own = depth(column, row);
  int found = -1;
  for (int y = std::max(0, row - reach); y <= std::min(image.height - 1, row + reach); ++y)
    for (int x = std::max(0, column - reach); x <= std::min(image.width - 1, column + reach); ++x)
      found += std::abs(static_cast<double>(depth(x, y)) - own) <= settings.step;
  return found;
}

void take_outliers(const OutlierFilter& settings, RangeImage& image) {
  std::vector<char> out(image.depth.size(), 0);
  const auto width = static_cast<std::size_t>(image.width);
  in_parallel(static_cast<std::size_t>(image.height), [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      if (std::isnan(image.depth[y * width + x])) continue;
      out[y * width + x] =
          neighbours_of(image, static_cast<int>(x), static_cast<int>(y), settings) < settings.neighbours;
    }
  });
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i]) take_away(image, i, Validity::outlier);
}

/// Whether exactly the valid pixels have a depth.
bool validity_agrees(const RangeImage& image) {
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if ((image.validity[i] == 0) != !std::isnan(image.depth[i])) return false;
  return true;
}

}  // namespace

void filter(const FilterSettings& settings, RangeImage& image) {
  if (!settings.any()) return;
  BIN_SCENES_ASSERT(image.depth.size() ==
                    static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  BIN_SCENES_ASSERT(image.label.size() == image.depth.size() && image.snr.size() == image.depth.size());
  BIN_SCENES_ASSERT(image.validity.size() == image.depth.size());
  // An exact image is its own truth until something is taken from it.
  if (image.truth_depth.empty()) image.truth_depth = image.depth;
  if (image.truth_label.empty()) image.truth_label = image.label;
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if (!std::isnan(image.depth[i]) && image.snr[i] < settings.snr) take_away(image, i, Validity::dark);
  if (settings.outlier.neighbours > 0) take_outliers(settings.outlier, image);
  if (settings.smoothing.sigma > 0.0) smooth(settings.smoothing, image);
  BIN_SCENES_ASSERT(validity_agrees(image));
}

}  // namespace bin_scenes
