/// Draws the predicted noise of a sensor as an SVG picture with two panels: noise over distance and noise over the
/// angle of incidence. `bin_scenes sensor --plot` writes it. The values are computed in sensor/metrics.hpp.
#pragma once

#include "bin_scenes/sensor/metrics.hpp"

#include <cmath>
#include <string>

namespace bin_scenes {

inline double degrees(double radians) {
  return radians * 180.0 / M_PI;
}

/// SVG with two panels, a curve for each albedo, sigma on one logarithmic scale: over distance, facing, and over
/// incidence at the centre distance. Throws an input Error for a sensor without noise, an environment Error if it
/// cannot be written.
void write_sigma_plot(const std::string& path, const SensorMetrics& metrics);

}  // namespace bin_scenes
