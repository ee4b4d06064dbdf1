#include "bin_scenes/config/gripper_presets.hpp"

#include "config/preset_files.hpp"

#include <cstdlib>

namespace bin_scenes {

std::string gripper_preset_directory() {
  std::vector<std::string> places;
  if (const char* sensors = std::getenv("BIN_SCENES_SENSORS"); sensors && *sensors)
    places.push_back(std::string(sensors) + "/../grippers");
  places.insert(places.end(), {BIN_SCENES_GRIPPER_SOURCE_DIR, BIN_SCENES_GRIPPER_INSTALL_DIR});
  for (const std::string& place : config::moved_presets("grippers")) places.push_back(place);
  return config::first_folder(places, "grippers", "keep the folder 'config/grippers' beside 'config/sensors'");
}

std::vector<std::string> gripper_presets() {
  return config::presets_in(gripper_preset_directory());
}

Gripper gripper_preset(const std::string& name) {
  const std::string path = config::preset_path(gripper_preset_directory(), name, "gripper preset");
  const YAML::Node root = config::preset_keys(path, "gripper keys");
  if (root["preset"])
    throw input_error("a preset must not name another preset", path, "write the values of that preset here");
  Gripper gripper = config::read_preset<Gripper>(root, path);
  gripper.preset = name;
  if (gripper.name.empty()) gripper.name = name;
  return gripper;
}

namespace config {

void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Gripper& gripper) {
  const YAML::Node name = map["preset"];
  if (!name || !name.IsScalar() || name.Scalar().empty()) return;
  try {
    gripper = gripper_preset(name.Scalar());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input || error.where() != gripper_preset_directory()) throw;
    throw input_error(error.problem(), source.where(path + ".preset"), error.remedy());
  }
}

}  // namespace config

}  // namespace bin_scenes
