#include "sensor/models/from_sensor.hpp"
#include "sensor/models/ideal.hpp"

#include <utility>

namespace bin_scenes {

Surfaces surfaces_of(const Request& request) {
  Surfaces surfaces;
  for (const PartLine& line : request.parts) surfaces.lines.push_back(line.surface);
  surfaces.bin = request.bin.surface;
  return surfaces;
}

RangeImage measure(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                   const Draw& draw) {
  RangeImage image;
  switch (sensor.model) {
    case SensorModel::ideal:
      image = measure_ideal(std::move(view));
      break;
    case SensorModel::structured_light:
      image = measure_structured_light(scenery, std::move(view), sensor, surfaces, draw);
      break;
    case SensorModel::laser_line:
      image = measure_laser_line(scenery, std::move(view), sensor, surfaces, draw);
      break;
    case SensorModel::stereo:
      image = measure_stereo(scenery, std::move(view), sensor, surfaces, draw);
      break;
    case SensorModel::time_of_flight:
      image = measure_time_of_flight(scenery, std::move(view), sensor, surfaces, draw);
      break;
  }
  image.sensor = sensor;
  if (image.width == 0) image.width = sensor.width, image.height = sensor.height;
  return image;
}

}  // namespace bin_scenes
