/// The image sensor of a camera: shot noise, read noise, and quantisation. A signal is a share of the full-well
/// capacity.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/scene/sensor_models.hpp"
#include "light/illumination.hpp"

#include <cstddef>
#include <vector>

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

/// The gain of an exposure: a white surface's signal is gain * reflected / distance^2. With automatic exposure, a white
/// matte surface parallel to the image, at the median distance of all points that are lit, gives the signal
/// ImagerSettings::exposure. Noise of triangulation then grows with the square of the range and not faster.
/// @param depths   m along the camera's axis, of the points of `lit`
/// @param light_z  m, depth of the light itself
double gain_of(const ImagerSettings& imager, const std::vector<Lit>& lit, const std::vector<double>& depths,
               double light_z);

}  // namespace bin_scenes
