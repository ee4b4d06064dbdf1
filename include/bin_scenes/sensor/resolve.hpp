/// Fills in the poses and intrinsics of a sensor that the request leaves out.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/sensor/lens.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the sensor with K and all poses filled in. By default the camera stands above the centre of the bin and
/// looks down (image right = bin x, image up = bin y), so that the whole rim is in view with a margin of 5 %. Projector
/// and laser stand a baseline away along the camera's x and are turned towards the centre of the bin. A bin without a
/// rim counts as a floor of Bin::inner_size. Throws an input Error if K or the range are impossible.
/// @param bounds  bounds of a mesh bin in the bin frame (m); null for other bins
Sensor resolved(const Sensor& sensor, const Bin& bin, const Aabb* bounds = nullptr);

/// All sensors of a request. Throws an input Error also for a camera, projector or laser that stands below the floor,
/// looks away from the bin or stands inside a part that is there from the start.
std::vector<Sensor> resolved_sensors(const LoadedRequest& loaded);

Lens lens_of(const Sensor& sensor);  ///< of the camera; K filled in
Lens lens_of(const Projector& projector);

}  // namespace bin_scenes
