#include "config/preset_files.hpp"

#include "config/suggest.hpp"
#include "core/share_folders.hpp"

#include <algorithm>
#include <filesystem>

namespace bin_scenes::config {

namespace fs = std::filesystem;

std::string first_folder(const std::vector<std::string>& places, const std::string& key, const std::string& remedy) {
  std::string tried;
  for (const std::string& place : places) {
    std::error_code failed;
    if (fs::is_directory(place, failed)) return place;
    tried += "\n  " + place;
  }
  throw environment_error("no folder of presets; looked for:" + tried, key, remedy);
}

std::vector<std::string> moved_presets(const std::string& kind) {
  std::vector<std::string> places;
  for (const fs::path& share : share_folders()) places.push_back((share / "config" / kind).string());
  return places;
}

std::vector<std::string> presets_in(const std::string& folder) {
  std::vector<std::string> presets;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") presets.push_back(entry.path().stem().string());
  }
  std::sort(presets.begin(), presets.end());
  return presets;
}

std::string preset_path(const std::string& folder, const std::string& name, const std::string& what) {
  const std::vector<std::string> known = presets_in(folder);
  if (std::find(known.begin(), known.end(), name) != known.end()) return (fs::path(folder) / (name + ".yaml")).string();
  const std::string meant = nearest(name, known);
  std::string remedy = "did you mean '" + meant + "'?";
  if (meant.empty()) {
    remedy = "there are:";
    for (const std::string& preset : known) remedy += " " + preset;
  }
  throw input_error("there is no " + what + " '" + name + "'", folder, remedy);
}

YAML::Node preset_keys(const std::string& path, const std::string& what) {
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

}  // namespace bin_scenes::config
