#include "bin_scenes/config/formats.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include <algorithm>

namespace bin_scenes {

const std::string& sensor_of_view(const Sensor& sensor) {
  return sensor.view_of.empty() ? sensor.name : sensor.view_of;
}

const char* const bop_misfit_remedy =
    "change the request's sensors (rectified images have distortion 0), or leave such outputs out";

std::string bop_misfit(const Sensor& sensor) {
  if (sensor_model(sensor.model).image == SensorModel::Image::profiles)
    return "BOP holds pinhole images, and the profiles of a " + sensor.model + " sensor are none";
  if (std::any_of(sensor.distortion.begin(), sensor.distortion.end(), [](double d) { return d != 0.0; }))
    return "BOP holds pinhole images, and the lens of sensor '" + sensor.name + "' distorts";
  return "";
}

std::string bop_loss(const std::vector<Sensor>& sensors) {
  const bool cut = std::any_of(sensors.begin(), sensors.end(), [](const Sensor& sensor) {
    return sensor.model == "image" && sensor.settings.of<ImageSettings>().bits > 8;
  });
  return cut ? "BOP's files hold the upper 8 bits of pictures of 16; png and image.png of shards hold all" : "";
}

const char* name_of(McapProfile profile) {
  return profile == McapProfile::ros1 ? "ros1" : "ros2";
}

McapProfile mcap_profile_of(const std::string& name, const std::string& where) {
  for (const McapProfile profile : {McapProfile::ros1, McapProfile::ros2})
    if (name == name_of(profile)) return profile;
  throw input_error("unknown profile '" + name + "' of MCAP files", where, "ros1 or ros2");
}

}  // namespace bin_scenes
