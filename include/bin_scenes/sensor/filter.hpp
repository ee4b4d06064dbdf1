/// Filters of a driver, which take measured pixels away; off by default.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

namespace bin_scenes {

/// A pixel stays if enough others of the window around it have nearly its depth.
struct OutlierFilter {
  int neighbours = 0;   ///< so many have to; 0 = off
  int window = 5;       ///< odd, pixel: edge of the window
  double step = 0.005;  ///< m: largest difference of depth
};

/// Kept in Sensor::settings.
struct FilterSettings {
  double snr = 0.0;  ///< pixels below are dark; 0 = off
  OutlierFilter outlier;
  bool any() const { return snr > 0.0 || outlier.neighbours > 0; }
};

/// First by SNR, then by neighbours: all of those are told at once, so that none depends on the order of pixels. Truth
/// stays.
void filter(const FilterSettings& settings, RangeImage& image);

}  // namespace bin_scenes
