/// The sensor model `time_of_flight`. The light source of the camera is at its lens, so that nothing is in shadow. The
/// model has noise along the ray and across it (time_of_flight_noise.hpp), mixed pixels whose light returns from two
/// depths, and light that arrives late via other surfaces (multipath.hpp).
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/view.hpp"
#include "light/illumination.hpp"
#include "light/indirect_field.hpp"
#include "sensor/models/measurement.hpp"

namespace bin_scenes {

struct TimeOfFlightSetup {
  TimeOfFlightSettings settings;
  bool noise = true;
  double near = 0.0, far = 1e9;  ///< m, range of depths that the camera reports
  IndirectField::Setup indirect{};
  bool gray = true;  ///< whether to compute the light of the grey image (Measurement::light)
};

/// @param random  random numbers of the noise
/// @param rays    random numbers for the samples of indirect light
Measurement time_of_flight(const Scenery& scenery, const View& view, const Surfaces& surfaces,
                           const TimeOfFlightSetup& setup, const Random& random,
                           const Random& rays = Random(0, 0, Stream::sensor));

}  // namespace bin_scenes
