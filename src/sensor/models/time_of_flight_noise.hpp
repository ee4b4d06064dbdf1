/// Noise of time-of-flight depth by distance and incidence, in the form that Fankhauser et al. 2015, "Kinect v2 for
/// Mobile Robot Navigation: Evaluation and Modeling", fitted to the time-of-flight camera Kinect v2 indoors:
///
///     sigma (mm) = 1.5 - 0.5 z + 0.3 z^2 + 0.1 z^1.5 t^2 / (pi/2 - t)^2      (z in m, t the angle of incidence)
///
/// The parabola is written by its vertex: axial + axial_growth (z - axial_distance)^2. The default settings are these
/// figures. The model adds what the paper leaves open: noise grows as the surface returns less light.
#pragma once

#include "bin_scenes/scene/sensor_models.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace detail {
/// The factor t / (pi/2 - t) of the paper's formula. It has a pole at an angle of incidence of 90 degrees, where no
/// camera measures. Beyond 80 degrees, the value for 80 degrees is used.
inline double tilt(double incidence) {
  const double t = std::min(incidence, M_PI * 80.0 / 180.0);
  return t / (0.5 * M_PI - t);
}
}  // namespace detail

/// Returns the standard deviation of depth (m) at the depth z (m) and the angle of incidence (rad). `signal` is the
/// albedo of a surface facing the camera that would give the same signal.
inline double axial_sigma(const TimeOfFlightSettings& s, double z, double incidence, double signal) {
  const double far = z - s.axial_distance, tilt = detail::tilt(incidence);
  const double sigma = s.axial + s.axial_growth * far * far + s.axial_angle * z * std::sqrt(z) * tilt * tilt;
  return s.albedo > 0.0 ? sigma * std::sqrt(s.albedo / std::max(signal, 1e-6)) : sigma;
}

/// Returns the standard deviation of the random sideways displacement of a pixel's ray (pixels).
inline double lateral_sigma(const TimeOfFlightSettings& s, double incidence) {
  return s.lateral + s.lateral_angle * detail::tilt(incidence);
}

}  // namespace bin_scenes
