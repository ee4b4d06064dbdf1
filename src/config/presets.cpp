/// Finds, lists and reads the files of presets. All kinds share the code; a table states what distinguishes them.
#include "bin_scenes/config/presets.hpp"

#include "config/key_reader.hpp"
#include "config/preset_files.hpp"
#include "config/suggest.hpp"
#include "core/data_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

/// What distinguishes one kind of presets from the others.
struct PresetKind {
  const char *folder, *item, *keys;
  const char* key;  ///< by which a request names a preset
};
template <class Struct>
constexpr PresetKind preset_kind = {};
template <>
constexpr PresetKind preset_kind<Sensor> = {"sensors", "sensor preset", "sensor keys", "preset"};
template <>
constexpr PresetKind preset_kind<Surface> = {"materials", "material", "surface keys", "material"};
template <>
constexpr PresetKind preset_kind<Gripper> = {"grippers", "gripper preset", "gripper keys", "preset"};

void set_name(Sensor& sensor, const std::string& preset) {
  sensor.preset = preset;
}
void set_name(Surface&, const std::string&) {}
void set_name(Gripper& gripper, const std::string& preset) {
  gripper.preset = preset;
  if (gripper.name.empty()) gripper.name = preset;
}

std::vector<std::string> presets_in(const std::string& folder) {
  std::vector<std::string> presets;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there)) {
    if (entry.path().extension() == ".yaml") presets.push_back(entry.path().stem().string());
  }
  std::sort(presets.begin(), presets.end());
  return presets;
}

YAML::Node keys_of(const std::string& path, const std::string& what) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw input_error("cannot be read", path, "name a file of " + what + " that exists and can be read");
  } catch (const YAML::Exception& error) {
    throw input_error("not YAML: " + error.msg, path + ":" + std::to_string(error.mark.line + 1),
                      "check indentation, brackets and colons");
  }
  if (!root.IsMap()) throw input_error("is not a map of " + what, path, "write `key: value` lines");
  return root;
}

template <class Struct>
Struct read_preset_file(const std::string& path) {
  const std::string key = preset_kind<Struct>.key;
  const YAML::Node root = keys_of(path, preset_kind<Struct>.keys);
  if (root[key])
    throw input_error("a " + key + " must not name another " + key, path, "write the values of that " + key + " here");
  Struct value;
  config::Source source(path, {});
  config::KeyReader reader(root, "", source);
  visit(reader, value);
  reader.finish();
  return value;
}

/// @param where  of an error if there is no such preset; empty: the folder
template <class Struct>
Struct read_preset(const std::string& name, const std::string& where = "") {
  const std::string folder = config::preset_directory(preset_kind<Struct>.folder);
  Struct value = read_preset_file<Struct>(
      config::preset_path(folder, name, preset_kind<Struct>.item, where.empty() ? folder : where));
  set_name(value, name);
  return value;
}

/// Gives a struct the values of the preset that its map names; false if it names none.
template <class Struct>
bool start(const YAML::Node& map, const std::string& path, const config::Source& source, Struct& value) {
  const std::string key = preset_kind<Struct>.key;
  const YAML::Node name = map[key];
  if (!name || !name.IsScalar() || name.Scalar().empty()) return false;
  value = read_preset<Struct>(name.Scalar(), source.where(path + "." + key));
  return true;
}

}  // namespace

std::vector<std::string> sensor_presets() {
  return presets_in(config::preset_directory(preset_kind<Sensor>.folder));
}
std::vector<std::string> materials() {
  return presets_in(config::preset_directory(preset_kind<Surface>.folder));
}
std::vector<std::string> gripper_presets() {
  return presets_in(config::preset_directory(preset_kind<Gripper>.folder));
}

Sensor sensor_preset(const std::string& name) {
  return read_preset<Sensor>(name);
}
Surface material(const std::string& name) {
  return read_preset<Surface>(name);
}
Gripper gripper_preset(const std::string& name) {
  return read_preset<Gripper>(name);
}

Sensor read_sensor_file(const std::string& path) {
  return read_preset_file<Sensor>(path);
}

namespace config {

std::string preset_directory(const std::string& kind) {
  std::vector<fs::path> places;
  const char* const set = std::getenv("BIN_SCENES_SENSORS");
  const bool given = set && *set, sensors = kind == "sensors";
  if (given) places.push_back(sensors ? fs::path(set) : fs::path(set) / ".." / kind);
  if (!given || !sensors)
    for (const fs::path& place : data_places("config/" + kind)) places.push_back(place);
  return first_place(places, "config/" + kind, "set BIN_SCENES_SENSORS to the folder 'config/sensors' of bin_scenes");
}

std::string preset_path(const std::string& folder, const std::string& name, const std::string& what,
                        const std::string& where) {
  const std::vector<std::string> known = presets_in(folder);
  if (std::find(known.begin(), known.end(), name) != known.end()) return (fs::path(folder) / (name + ".yaml")).string();
  const std::string meant = nearest(name, known);
  std::string remedy = "did you mean '" + meant + "'?";
  if (meant.empty()) {
    remedy = "there are:";
    for (const std::string& preset : known) remedy += " " + preset;
  }
  throw input_error("there is no " + what + " '" + name + "'", where, remedy);
}

void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Surface& surface) {
  start(map, path, source, surface);
}

void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Gripper& gripper) {
  start(map, path, source, gripper);
}

void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Sensor& sensor) {
  if (!start(map, path, source, sensor)) return;
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
