/// The sensor model `image`: a camera that takes grey or colour pictures in the light of lamps. path_tracer.hpp
/// computes the light.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "light/lamps.hpp"
#include "sensor/models/measurement.hpp"

namespace bin_scenes {

/// Exact depth, the grey value as intensity and its SNR, and the picture itself.
/// @param sensor  resolved()
/// @param paths, noise  keys of the random numbers
Measurement take_image(const Scenery& scenery, const View& view, const Sensor& sensor, const Surfaces& surfaces,
                       const Random& paths, const Random& noise, Picture& picture);

/// Signal / radiance: a white matte surface that faces the camera, at reference_distance along its axis or, if that is
/// 0, at the median depth of the view, has the signal `exposure` where nothing occludes it. 0 where no lamp lights it.
double image_gain(const Lamps& lamps, const Sensor& sensor, const View& view);

}  // namespace bin_scenes
