/// Fills in the poses and camera matrices of sensors that the request leaves out. Everything that makes images uses
/// resolved sensors only.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/raster/lens.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the sensor with K and all poses filled in. By default, the camera is above the centre of the bin and looks
/// down (image right = bin x, image up = bin y), so that the whole rim is in view with a margin of 5 %. Projector and
/// laser are a baseline away along the camera's x axis and are turned towards the centre of the bin. A bin without a
/// rim counts as a floor of Bin::inner_size. Throws an input Error if K or the range is impossible.
/// @param bounds  bounds of a mesh bin in the bin frame (m); null for other bins
Sensor resolved(const Sensor& sensor, const Bin& bin, const Aabb* bounds = nullptr);

/// Returns all sensors of a request, resolved. Also throws an input Error for a camera, projector or laser that is
/// below the floor, looks away from the bin, or is inside a part that is there from the start.
std::vector<Sensor> resolved_sensors(const LoadedRequest& loaded);

}  // namespace bin_scenes
