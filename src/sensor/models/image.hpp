/// The sensor model `image`: a camera that takes grey or colour pictures in the light of lamps. path_tracer.hpp
/// computes the light.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "light/lamps.hpp"
#include "sensor/models/measurement.hpp"

namespace bin_scenes {

/// Takes an image: fills `picture`, and returns exact depth, the grey value as intensity, and its SNR.
/// @param sensor        sensor with all settings filled in by resolved()
/// @param paths, noise  random numbers of the light paths and of the sensor noise
Measurement take_image(const Scenery& scenery, const View& view, const Sensor& sensor, const Surfaces& surfaces,
                       const Random& paths, const Random& noise, Picture& picture);

/// Returns signal / radiance, with which an unoccluded white matte surface facing the camera at reference_distance (if
/// 0: at the median depth of the view) has the signal `exposure`; 0 if no lamp lights that surface.
double image_gain(const Lamps& lamps, const Sensor& sensor, const View& view);

}  // namespace bin_scenes
