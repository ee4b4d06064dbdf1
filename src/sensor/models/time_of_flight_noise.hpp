/// Nguyen, Izadi, Lovell 2012, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking", equations 1
/// and 2, with their constants as settings.
#pragma once

#include "bin_scenes/scene/sensor_models.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace detail {
/// Their formulas have a pole at 90 degrees and were measured up to 80.
inline double left_to_grazing(double incidence) {
  return std::max(0.5 * M_PI - incidence, 0.02);
}
}  // namespace detail

/// Standard deviation of depth (m) at z (m) under an incidence (rad); `signal` as seen by a facing surface of that
/// albedo.
inline double axial_sigma(const TimeOfFlightSettings& s, double z, double incidence, double signal) {
  const double far = z - s.axial_distance, tilt = incidence / detail::left_to_grazing(incidence);
  const double sigma = s.axial + s.axial_growth * far * far + s.axial_angle / std::sqrt(z) * tilt * tilt;
  return s.albedo > 0.0 ? sigma * std::sqrt(s.albedo / std::max(signal, 1e-6)) : sigma;
}

/// Standard deviation of a ray's jitter, pixels.
inline double lateral_sigma(const TimeOfFlightSettings& s, double incidence) {
  return s.lateral + s.lateral_angle * incidence / detail::left_to_grazing(incidence);
}

}  // namespace bin_scenes
