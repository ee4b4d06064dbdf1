/// Access to folders of presets: config/sensors, config/materials and config/grippers. Each file contains the values of
/// one preset. This header finds and lists the files; the readers of each kind interpret them.
#pragma once

#include "config/key_reader.hpp"

#include <string>
#include <vector>

namespace bin_scenes::config {

/// The first of some folders that is there. Throws an environment Error at `key`.
std::string first_folder(const std::vector<std::string>& places, const std::string& key, const std::string& remedy);
/// Returns the folder `config/KIND` of an installation that was moved.
std::vector<std::string> moved_presets(const std::string& kind);
/// Names of all presets of a folder, sorted.
std::vector<std::string> presets_in(const std::string& folder);
/// Throws an input Error that names the nearest preset. @param what  "sensor preset"
std::string preset_path(const std::string& folder, const std::string& name, const std::string& what);
/// The keys of such a file. @param what  "sensor keys"
YAML::Node preset_keys(const std::string& path, const std::string& what);

template <class Struct>
Struct read_preset(const YAML::Node& root, const std::string& path) {
  Struct value;
  Source source(path, {});
  KeyReader reader(root, "", source);
  visit(reader, value);
  reader.finish();
  return value;
}

}  // namespace bin_scenes::config
