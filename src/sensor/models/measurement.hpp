/// The result of a sensor model: the measured values of all pixels. All models return this struct; of_sensor.hpp turns
/// it into a RangeImage.
#pragma once

#include "bin_scenes/scene/validity.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace bin_scenes {

/// Measured values of all pixels, row-major in the size of the sensor's image.
struct Measurement {
  std::vector<double> depth;  ///< m; NaN where the code is not valid
  std::vector<Validity> validity;
  std::vector<float> intensity;  ///< mean signal / full well, at most 1
  std::vector<float> light;      ///< light of the grey image, in any unit and without noise; empty: it is `intensity`
  std::vector<float> snr;        ///< signal / predicted standard deviation of its noise; meaningless where not valid

  explicit Measurement(std::size_t pixels)
      : depth(pixels, std::numeric_limits<double>::quiet_NaN()),
        validity(pixels, Validity::nothing),
        intensity(pixels, 0.0f),
        snr(pixels, 0.0f) {}
};

}  // namespace bin_scenes
