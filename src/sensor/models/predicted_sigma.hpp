/// Noise of a sensor by the formulas of its model.
#pragma once

#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Standard deviation of the depth (m) of a matte plate on the optical axis; 0 of `ideal`, NaN where nothing is
/// measured.
/// @param sensor     resolved()
/// @param distance   m along the optical axis
/// @param incidence  rad, by which the plate is turned about the camera's x
double predicted_sigma(const Sensor& sensor, double distance, double incidence, double albedo);

}  // namespace bin_scenes
