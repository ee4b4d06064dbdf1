#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include <utility>

namespace bin_scenes {

RangeImage measure(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                   const Draw& draw) {
  RangeImage image = sensor_model(sensor.model).measure(scenery, std::move(view), sensor, surfaces, draw);
  image.sensor = sensor;
  if (image.width == 0) image.width = sensor.width, image.height = sensor.height;
  image.snr.resize(image.validity.size(), 0.0f);  // a model need not predict its noise
  for (std::size_t i = 0; i < image.snr.size(); ++i)
    if (image.validity[i] != static_cast<std::uint8_t>(Validity::valid)) image.snr[i] = 0.0f;
  filter(sensor.settings.of<FilterSettings>(), image);
  return image;
}

double predicted_sigma(const Sensor& sensor, double distance, double incidence, double albedo) {
  const SensorModel& model = sensor_model(sensor.model);
  return sensor.noise ? model.predicted_sigma(sensor, distance, incidence, albedo) : 0.0;
}

}  // namespace bin_scenes
