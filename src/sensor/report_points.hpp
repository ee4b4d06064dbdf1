/// Converts the depths that a true device measured into those that it reports with its assumed calibration
/// (sensor/calibration.hpp). Pixels whose point has no valid depth afterwards become invalid. Each sensor model
/// provides the conversion of one depth.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "core/in_parallel.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

/// @param depth_of  function (column, row, measured depth) -> reported depth (m); not finite: no depth is reported
/// @param none      validity code of the pixels for which no depth is reported
template <class DepthOf>
void report_depths(RangeImage& image, const DepthOf& depth_of, Validity none = Validity::decoding) {
  const auto width = static_cast<std::size_t>(image.width);
  in_parallel(static_cast<std::size_t>(image.height), [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t i = row * width + column;
      if (std::isnan(image.depth[i])) continue;
      const double depth = depth_of(static_cast<double>(column), static_cast<double>(row), image.depth[i]);
      image.depth[i] = static_cast<float>(depth);
      if (std::isfinite(depth)) continue;
      image.depth[i] = std::numeric_limits<float>::quiet_NaN();
      image.validity[i] = static_cast<std::uint8_t>(none);
      image.label[i] = 0;
      image.snr[i] = 0.0f;
    }
  });
}

}  // namespace bin_scenes
