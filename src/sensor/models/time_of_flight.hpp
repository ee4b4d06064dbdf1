/// A time-of-flight camera: its light stands beside the lens, so nothing is in shadow; noise along the ray and across
/// it (time_of_flight_noise.hpp), and pixels whose light comes back from two depths.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/view.hpp"
#include "sensor/models/illumination.hpp"
#include "sensor/models/measurement.hpp"

namespace bin_scenes {

/// @param near, far  m, depths that the camera reports
Measurement time_of_flight(const Scenery& scenery, const View& view, const Surfaces& surfaces,
                           const TimeOfFlightSettings& settings, bool noise, double near, double far,
                           const Random& random);

}  // namespace bin_scenes
