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

/// Writes an SVG file with one curve per albedo: sigma on a logarithmic scale over the distance of a surface that faces
/// the sensor, and over the angle of incidence at the central distance. Throws an input Error for a sensor without
/// noise, and an environment Error if the file cannot be written.
void write_sigma_plot(const std::string& path, const SensorMetrics& metrics);

}  // namespace bin_scenes
