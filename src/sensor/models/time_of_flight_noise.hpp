/// Noise of time-of-flight depth: equations 1 and 2 of Nguyen, Izadi, Lovell 2012, "Modeling Kinect Sensor Noise for
/// Improved 3D Reconstruction and Tracking". The constants of the paper are the default settings.
#pragma once

#include "bin_scenes/scene/sensor_models.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace detail {
/// The factor t / (pi/2 - t) of the paper's formulas. It has a pole at 90 degrees, and the authors measured up to 80
/// degrees. Beyond 80 degrees, the value stays that of 80 degrees.
inline double tilt(double incidence) {
  const double t = std::min(incidence, M_PI * 80.0 / 180.0);
  return t / (0.5 * M_PI - t);
}
}  // namespace detail

/// Standard deviation of depth (m) at z (m) under an incidence (rad); `signal` as seen by a facing surface of that
/// albedo.
inline double axial_sigma(const TimeOfFlightSettings& s, double z, double incidence, double signal) {
  const double far = z - s.axial_distance, tilt = detail::tilt(incidence);
  const double sigma = s.axial + s.axial_growth * far * far + s.axial_angle / std::sqrt(z) * tilt * tilt;
  return s.albedo > 0.0 ? sigma * std::sqrt(s.albedo / std::max(signal, 1e-6)) : sigma;
}

/// Standard deviation of a ray's jitter, pixels.
inline double lateral_sigma(const TimeOfFlightSettings& s, double incidence) {
  return s.lateral + s.lateral_angle * detail::tilt(incidence);
}

}  // namespace bin_scenes
