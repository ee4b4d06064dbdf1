/// Presets of sensors: files of config/sensors with the keys of one item of a request's `sensors`.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Folder of the presets: $BIN_SCENES_SENSORS, else of the source tree or the installation. Throws an environment
/// Error.
std::string sensor_preset_directory();
/// Names of all presets, sorted.
std::vector<std::string> sensor_presets();
/// A sensor with the values of the preset of that name. Throws an input Error that names the nearest preset.
Sensor sensor_preset(const std::string& name);
/// A sensor with the values of a file in the format of the presets.
Sensor read_sensor_file(const std::string& path);

}  // namespace bin_scenes
