/// The models with the settings of a request's sensor.
#pragma once

#include "bin_scenes/sensor/models.hpp"
#include "sensor/models/laser_line.hpp"
#include "sensor/models/stereo.hpp"
#include "sensor/models/structured_light.hpp"

namespace bin_scenes {

/// @param sensor  resolved()
StructuredLight::Setup structured_light_setup(const Sensor& sensor);
Stereo::Setup stereo_setup(const Sensor& sensor);
LaserLine::Setup laser_line_setup(const Sensor& sensor);

// Each image takes over what it needs of the view as truth.
RangeImage measure_structured_light(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                                    const Draw& draw);
RangeImage measure_stereo(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                          const Draw& draw);
RangeImage measure_time_of_flight(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                                  const Draw& draw);
RangeImage measure_laser_line(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                              const Draw& draw);

}  // namespace bin_scenes
