/// The image sensor of a camera: shot noise, read noise, and quantisation. A signal is a share of the full-well
/// capacity.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/scene/sensor_models.hpp"

#include <cstddef>

namespace bin_scenes {

class Imager {
 public:
  /// @param noise  false: neither shot nor read noise; the converter's steps stay
  Imager(const ImagerSettings& settings, bool noise);

  /// Variance of what is read for a mean signal, the converter's steps included.
  double variance(double signal) const;
  /// Reads `count` mean signals in place.
  void expose(float* signals, std::size_t count, Random& random) const;
  bool saturated(double signal) const { return signal >= 1.0 - 0.5 / steps_; }

 private:
  double shot_, read_, steps_;  ///< variance per signal, variance, steps of the converter
  double rounding_;             ///< variance of the converter's steps
  bool noise_;
};

}  // namespace bin_scenes
