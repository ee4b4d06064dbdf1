/// Filters of a driver, which take measured pixels away or smooth them; off by default.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

namespace bin_scenes {

/// A pixel stays if enough others of the window around it have nearly its depth.
struct OutlierFilter {
  int neighbours = 0;   ///< how many must have nearly the same depth; 0 = off
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

/// Replaces each depth by that of a plane through the surrounding pixels of the same surface, which drivers call
/// smoothing or surface smoothness. The SNR remains that of the measurement.
struct SmoothingFilter {
  double sigma = 0.0;   ///< pixel: standard deviation of the weights; 0 = off
  double step = 0.005;  ///< m: pixels farther off the plane have no weight
};

/// Kept in Sensor::settings.
struct FilterSettings {
  double snr = 0.0;  ///< pixels below are dark; 0 = off
  OutlierFilter outlier;
  ReflectionFilter reflection{};
  SmoothingFilter smoothing{};
  bool any() const { return snr > 0.0 || outlier.neighbours > 0 || reflection.step > 0.0 || smoothing.sigma > 0.0; }
};

/// Removes pixels by SNR, then by their neighbours, and smooths what is left (the sensor model itself has applied the
/// reflection filter). Each filter treats all pixels at once, so that the result does not depend on their order. The
/// true images do not change.
void filter(const FilterSettings& settings, RangeImage& image);

}  // namespace bin_scenes
