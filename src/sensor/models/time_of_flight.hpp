/// A time-of-flight camera: its light stands beside the lens, so nothing is in shadow; noise along the ray and across
/// it (time_of_flight_noise.hpp), and pixels whose light comes back from two depths.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/view.hpp"
#include "sensor/models/illumination.hpp"
#include "sensor/models/measurement.hpp"

namespace bin_scenes {

/// Depths that a camera reports, m.
struct DepthRange {
  double near, far;
};

Measurement time_of_flight(const Scenery& scenery, const View& view, const Surfaces& surfaces,
                           const TimeOfFlightSettings& settings, bool noise, const DepthRange& range,
                           const Random& random);

}  // namespace bin_scenes
