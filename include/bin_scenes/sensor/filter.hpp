/// Filters of a driver, which take measured pixels away or smooth them; off by default.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

namespace bin_scenes {

/// A pixel stays if enough others of the window around it have nearly its depth.
struct OutlierFilter {
  int neighbours = 0;   ///< so many have to; 0 = off
  int window = 5;       ///< odd, pixel: edge of the window
  double step = 0.005;  ///< m: largest difference of depth
};

/// The fringe of structured light is taken in a second period as well. Light that bounced moves the phase by another
/// depth there, direct light does not: Gupta et al. 2011, "Structured light 3D scanning in the presence of global
/// illumination".
struct ReflectionFilter {
  double step = 0.0;    ///< m: largest difference of both depths; 0 = off
  double period = 5.0;  ///< projector pixels of the second fringe: the shorter, the less light that bounced moves it
};

/// Depth becomes that of a plane through the pixels around, on one surface with it: what drivers call smoothing or
/// surface smoothness. SNR stays that of the measurement.
struct SmoothingFilter {
  double sigma = 0.0;   ///< pixel: standard deviation of the weights; 0 = off
  double step = 0.005;  ///< m: pixels that lie so far off the plane count nothing
};

/// Kept in Sensor::settings.
struct FilterSettings {
  double snr = 0.0;  ///< pixels below are dark; 0 = off
  OutlierFilter outlier;
  ReflectionFilter reflection{};
  SmoothingFilter smoothing{};
  bool any() const { return snr > 0.0 || outlier.neighbours > 0 || reflection.step > 0.0 || smoothing.sigma > 0.0; }
};

/// First by SNR, then by neighbours (the model itself has seen to reflections); what is left is smoothed. Each does all
/// pixels at once, so that none depends on their order. Truth stays.
void filter(const FilterSettings& settings, RangeImage& image);

}  // namespace bin_scenes
