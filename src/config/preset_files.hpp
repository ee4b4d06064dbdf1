/// Finds and lists the files of presets; presets.cpp reads them, and rigs.cpp those of rigs.
#pragma once

#include <string>

namespace bin_scenes::config {

/// Returns the folder config/KIND. Throws an environment Error if there is none.
std::string preset_directory(const std::string& kind);
/// Returns the file of a preset. Throws an input Error at `where` that suggests the nearest name if there is none.
/// @param what  name of the kind of preset for the message, such as "sensor preset"
std::string preset_path(const std::string& folder, const std::string& name, const std::string& what,
                        const std::string& where);

}  // namespace bin_scenes::config
