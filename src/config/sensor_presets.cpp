#include "bin_scenes/config/sensor_presets.hpp"

#include "config/preset_files.hpp"

#include <cstdlib>

namespace bin_scenes {

std::string sensor_preset_directory() {
  std::vector<std::string> places;
  if (const char* set = std::getenv("BIN_SCENES_SENSORS"); set && *set) {
    places = {set};
  } else {
    places = config::moved_presets("sensors");
    places.insert(places.begin(), {BIN_SCENES_SENSOR_SOURCE_DIR, BIN_SCENES_SENSOR_INSTALL_DIR});
  }
  return config::first_folder(places, "sensors", "set BIN_SCENES_SENSORS to the folder 'config/sensors' of bin_scenes");
}

std::vector<std::string> sensor_presets() {
  return config::presets_in(sensor_preset_directory());
}

Sensor read_sensor_file(const std::string& path) {
  const YAML::Node root = config::preset_keys(path, "sensor keys");
  if (root["preset"])
    throw input_error("a preset must not name another preset", path, "write the values of that preset here");
  return config::read_preset<Sensor>(root, path);
}

Sensor sensor_preset(const std::string& name) {
  Sensor sensor = read_sensor_file(config::preset_path(sensor_preset_directory(), name, "sensor preset"));
  sensor.preset = name;
  return sensor;
}

namespace config {

void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Sensor& sensor) {
  const YAML::Node name = map["preset"];
  if (!name || !name.IsScalar() || name.Scalar().empty()) return;
  try {
    sensor = sensor_preset(name.Scalar());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input || error.where() != sensor_preset_directory()) throw;
    throw input_error(error.problem(), source.where(path + ".preset"), error.remedy());
  }
  // Keys that stand for each other: what the request says goes before what the preset says in other words.
  if (map["fov"] && !map["k"]) sensor.k.clear();
  const auto moves = [&](const char* part) {
    const YAML::Node own = map[part];
    return own && own.IsMap() && own["baseline"] && !own["pose"];
  };
  if (moves("projector")) sensor.projector.pose.reset();
  if (moves("laser")) sensor.laser.pose.reset();
}

}  // namespace config

}  // namespace bin_scenes
