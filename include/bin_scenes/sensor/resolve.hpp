/// Fills in the poses and intrinsics of a sensor that the request leaves out.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/sensor/lens.hpp"

#include <vector>

namespace bin_scenes {

/// Sensor with K and all poses filled in. By default the camera stands above the middle of the bin, looking down (image
/// right = bin x, image up = bin y), the whole rim in view with a margin of 5 %; projector and laser stand a baseline
/// away along the camera's x and are turned towards the middle of the bin. `bounds` of a mesh bin in the bin frame; a
/// bin without rim is taken for a floor of Bin::inner_size. Throws an input Error if K or the range make no sense.
Sensor resolved(const Sensor& sensor, const Bin& bin, const Aabb* bounds = nullptr);

/// All sensors of a request. `bin_model` of a bin given as a mesh. Throws an input Error also for a camera, projector
/// or laser that stands below the floor, looks away from the bin or stands inside a part that is there from the start.
std::vector<Sensor> resolved_sensors(const Request& request, const std::vector<PartModelPtr>& parts,
                                     const PartModelPtr& bin_model);

Lens lens_of(const Sensor& sensor);  ///< of the camera; K filled in
Lens lens_of(const Projector& projector);

}  // namespace bin_scenes
