/// Filters that drivers of real sensors apply to measured images: they remove or smooth pixels. All are off by default.
/// The true images do not change.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

namespace bin_scenes {

/// A pixel is kept if enough other pixels of the window around it have nearly the same depth.
struct OutlierFilter {
  int neighbours = 0;   ///< required number of pixels with nearly the same depth; 0: off
  int window = 5;       ///< edge length of the window (pixels), odd
  double step = 0.005;  ///< largest difference of depth (m)
};

/// Structured light measures the phase with fringes of a second period as well. Reflected light shifts the depths of
/// both periods differently, and direct light does not: Gupta et al. 2011, "Structured light 3D scanning in the
/// presence of global illumination".
struct ReflectionFilter {
  double step = 0.0;    ///< largest difference between the two depths (m); 0: off
  double period = 5.0;  ///< projector pixels: the second period; the shorter it is, the less reflected light shifts it
};

/// Removes pixels on both sides of a step of depth, where spots of light and windows of pixels cover two surfaces.
struct EdgeFilter {
  int reach = 0;        ///< distance from the step up to which pixels are removed; 0: off
  double step = 0.005;  ///< smallest difference of depth (m) between adjacent pixels that is a step
};

/// Removes small regions of connected pixels.
struct ClusterFilter {
  int pixels = 0;       ///< regions of fewer pixels are removed; 0: off
  double step = 0.005;  ///< adjacent pixels whose depths differ by at most this much (m) are connected
};

/// Replaces each depth by the median of the depths around it. Missing pixels are neither filled nor counted.
struct MedianFilter {
  int window = 0;  ///< edge length of the window (pixels), odd; 0: off
};

/// Replaces each depth by that of a plane through the surrounding pixels of the same surface. Drivers call this
/// smoothing or surface smoothness. The SNR remains that of the measurement.
struct SmoothingFilter {
  double sigma = 0.0;   ///< standard deviation of the weights (pixels); 0: off
  double step = 0.005;  ///< pixels farther from the plane than this (m) have no weight
};

/// All filters of a sensor. The struct is stored in Sensor::settings.
struct FilterSettings {
  double snr = 0.0;  ///< pixels with a lower SNR become dark; 0: off
  OutlierFilter outlier;
  ReflectionFilter reflection{};
  double incidence = 0.0;  ///< largest angle (rad) between measured normal and ray; 0: off
  EdgeFilter edge{};
  ClusterFilter cluster{};
  MedianFilter median{};
  SmoothingFilter smoothing{};
  bool any() const {
    return snr > 0.0 || outlier.neighbours > 0 || reflection.step > 0.0 || incidence > 0.0 || edge.reach > 0 ||
           cluster.pixels > 0 || median.window > 0 || smoothing.sigma > 0.0;
  }
};

/// Removes pixels by SNR, neighbours, incidence, edges and size of their region, in this order. Then it replaces depths
/// by medians and smooths them. The sensor model itself has applied the reflection filter before. Each filter treats
/// all pixels at once, so that the result does not depend on their order. The true images do not change.
void filter(const FilterSettings& settings, RangeImage& image);

}  // namespace bin_scenes
