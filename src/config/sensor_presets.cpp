#include "bin_scenes/config/sensor_presets.hpp"

#include "config/key_reader.hpp"
#include "config/suggest.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;

std::string sensor_preset_directory() {
  std::vector<fs::path> places;
  if (const char* set = std::getenv("BIN_SCENES_SENSORS"); set && *set) {
    places = {set};
  } else {
    std::error_code failed;
    const fs::path executable = fs::read_symlink("/proc/self/exe", failed);
    places = {BIN_SCENES_SENSOR_SOURCE_DIR, BIN_SCENES_SENSOR_INSTALL_DIR};
    // Of an installation that was moved: the command line lies in bin, the node in lib/bin_scenes.
    for (const char* up : {"..", "../.."})
      if (!failed) places.push_back(executable.parent_path() / up / "share/bin_scenes/config/sensors");
  }
  std::string tried;
  for (const fs::path& place : places) {
    std::error_code failed;
    if (fs::is_directory(place, failed)) return place.string();
    tried += "\n  " + place.string();
  }
  throw environment_error("no folder of sensor presets; looked for:" + tried, "sensors",
                          "set BIN_SCENES_SENSORS to the folder 'config/sensors' of bin_scenes");
}

std::vector<std::string> sensor_presets() {
  std::vector<std::string> presets;
  for (const fs::directory_entry& entry : fs::directory_iterator(sensor_preset_directory())) {
    if (entry.path().extension() == ".yaml") presets.push_back(entry.path().stem().string());
  }
  std::sort(presets.begin(), presets.end());
  return presets;
}

Sensor read_sensor_file(const std::string& path) {
  config::Source source(path, {});
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw input_error("cannot be read", path, "name a file of sensor keys that is there and readable");
  } catch (const YAML::Exception& error) {
    throw input_error("not YAML: " + error.msg, path + ":" + std::to_string(error.mark.line + 1),
                      "mind indentation, brackets and colons");
  }
  if (!root.IsMap()) throw input_error("is no map of sensor keys", path, "write `key: value` lines");
  if (root["preset"]) throw input_error("a preset names a preset", path, "write the values themselves");
  Sensor sensor;
  config::KeyReader reader(root, "", source);
  visit(reader, sensor);
  reader.finish();
  return sensor;
}

Sensor sensor_preset(const std::string& name) {
  const std::vector<std::string> known = sensor_presets();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    const std::string meant = config::nearest(name, known);
    std::string remedy = "did you mean '" + meant + "'?";
    if (meant.empty()) {
      remedy = "there are:";
      for (const std::string& preset : known) remedy += " " + preset;
    }
    throw input_error("there is no sensor preset '" + name + "'", sensor_preset_directory(), remedy);
  }
  Sensor sensor = read_sensor_file((fs::path(sensor_preset_directory()) / (name + ".yaml")).string());
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
