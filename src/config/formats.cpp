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

namespace {

std::vector<SceneFormat>& formats() {
  using Needs = SceneFormat::Needs;
  static std::vector<SceneFormat> all = {{"json"},
                                         {"pcd", Needs::sensors},
                                         {"ply", Needs::sensors},
                                         {"png", Needs::sensors},
                                         {"gray", Needs::sensors, true},
                                         {"bop", Needs::sensors, true},
                                         {"bag", Needs::images},
                                         {"mcap", Needs::images},
                                         {"grasps", Needs::images}};
  return all;
}

}  // namespace

const std::vector<SceneFormat>& scene_formats() {
  return formats();
}

const SceneFormat* find_scene_format(const std::string& name) {
  const auto known =
      std::find_if(formats().begin(), formats().end(), [&](const SceneFormat& format) { return format.name == name; });
  return known == formats().end() ? nullptr : &*known;
}

void add_scene_format(const SceneFormat& format) {
  formats().push_back(format);
}

std::string format_names(const char* last, const std::vector<std::string>& more) {
  std::vector<std::string> names;
  for (const SceneFormat& format : formats()) names.push_back(format.name);
  names.insert(names.end(), more.begin(), more.end());
  std::string text = names.front();
  for (std::size_t i = 1; i < names.size(); ++i)
    text += (i + 1 < names.size() ? ", " : std::string(" ") + last + " ") + names[i];
  return text;
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
