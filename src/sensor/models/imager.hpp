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
  /// @param noise  false: no shot noise and no read noise, only quantisation by the analog-to-digital converter
  Imager(const ImagerSettings& settings, bool noise);

  /// Returns the variance of a reading whose mean is `signal`, quantisation included.
  double variance(double signal) const;
  /// Replaces `count` mean signals by random readings: with noise, clipped to 0 to 1, and quantised.
  void expose(float* signals, std::size_t count, Random& random) const;
  bool saturated(double signal) const { return signal >= 1.0 - 0.5 / steps_; }

 private:
  double shot_, read_, steps_;  ///< shot noise: variance / signal; variance of read noise; largest count
  double rounding_;             ///< variance of quantisation
  bool noise_;
};

/// Returns the gain of an exposure: the signal of a white surface is gain * Lit::reflected / distance^2. With automatic
/// exposure, a white matte surface parallel to the image, at the median distance of all points that are lit, has the
/// signal ImagerSettings::exposure. Noise of triangulation then grows with the square of the range and not faster.
/// @param depths   depths of the points of `lit` along the camera's axis (m)
/// @param light_z  depth of the light source along the camera's axis (m)
double gain_of(const ImagerSettings& imager, const std::vector<Lit>& lit, const std::vector<double>& depths,
               double light_z);

}  // namespace bin_scenes
