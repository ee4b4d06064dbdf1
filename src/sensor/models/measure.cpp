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

namespace {

RangeImage measured(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                    const Draw& draw) {
  switch (sensor.model) {
    case SensorModel::ideal:
      return measure_ideal(std::move(view));
    case SensorModel::structured_light:
      return measure_structured_light(scenery, std::move(view), sensor, surfaces, draw);
    case SensorModel::laser_line:
      return measure_laser_line(scenery, std::move(view), sensor, surfaces, draw);
    case SensorModel::stereo:
      return measure_stereo(scenery, std::move(view), sensor, surfaces, draw);
    case SensorModel::time_of_flight:
      return measure_time_of_flight(scenery, std::move(view), sensor, surfaces, draw);
  }
  no_sensor_model("number " + std::to_string(static_cast<int>(sensor.model)));
}

}  // namespace

RangeImage measure(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                   const Draw& draw) {
  RangeImage image = measured(scenery, std::move(view), sensor, surfaces, draw);
  image.sensor = sensor;
  if (image.width == 0) image.width = sensor.width, image.height = sensor.height;
  return image;
}

}  // namespace bin_scenes
