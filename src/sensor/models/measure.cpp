#include "bin_scenes/core/error.hpp"
#include "sensor/models/ideal.hpp"

namespace bin_scenes {

Surfaces surfaces_of(const Request& request) {
  Surfaces surfaces;
  for (const PartLine& line : request.parts) surfaces.lines.push_back(line.surface);
  surfaces.bin = request.bin.surface;
  return surfaces;
}

RangeImage measure(const Scenery&, View&& view, const Sensor& sensor, const Surfaces&, const Draw&) {
  RangeImage image;
  switch (sensor.model) {
    case SensorModel::ideal:
      image = measure_ideal(std::move(view));
      break;
    default:
      throw input_error(std::string("there is no model ") + name_of(sensor.model) + " in this build",
                        "sensors: " + sensor.name, "set its model to ideal");
  }
  image.sensor = sensor;
  if (image.width == 0) image.width = view.lens.width, image.height = view.lens.height;
  return image;
}

}  // namespace bin_scenes
