#include "bin_scenes/config/materials.hpp"

#include "config/preset_files.hpp"

#include <cstdlib>

namespace bin_scenes {

std::string material_directory() {
  std::vector<std::string> places;
  if (const char* sensors = std::getenv("BIN_SCENES_SENSORS"); sensors && *sensors)
    places.push_back(std::string(sensors) + "/../materials");
  places.insert(places.end(), {BIN_SCENES_MATERIAL_SOURCE_DIR, BIN_SCENES_MATERIAL_INSTALL_DIR});
  for (const std::string& place : config::moved_presets("materials")) places.push_back(place);
  return config::first_folder(places, "surface", "keep the folder 'config/materials' beside 'config/sensors'");
}

std::vector<std::string> materials() {
  return config::presets_in(material_directory());
}

Surface material(const std::string& name) {
  const std::string path = config::preset_path(material_directory(), name, "material");
  const YAML::Node root = config::preset_keys(path, "surface keys");
  if (root["material"])
    throw input_error("a material must not name another material", path, "write the values of that material here");
  return config::read_preset<Surface>(root, path);
}

namespace config {

void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Surface& surface) {
  const YAML::Node name = map["material"];
  if (!name || !name.IsScalar() || name.Scalar().empty()) return;
  try {
    surface = material(name.Scalar());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input || error.where() != material_directory()) throw;
    throw input_error(error.problem(), source.where(path + ".material"), error.remedy());
  }
}

}  // namespace config

}  // namespace bin_scenes
