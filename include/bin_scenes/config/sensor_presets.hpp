/// Presets of sensors. A preset is a file of config/sensors that contains the keys of one item of `sensors` in a
/// request, with the data of one device. A request names a preset with the key `preset`, and keys that are given beside
/// it override those of the preset.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the folder of the presets: $BIN_SCENES_SENSORS if it is set, otherwise the folder of the source tree or of
/// the installation. Throws an environment Error if there is none.
std::string sensor_preset_directory();
/// Returns the names of all presets, sorted.
std::vector<std::string> sensor_presets();
/// Returns a sensor with the values of the preset of that name. Throws an input Error that suggests the nearest name if
/// the preset does not exist.
Sensor sensor_preset(const std::string& name);
/// Returns a sensor with the values of a file in the format of the presets. Throws an input Error.
Sensor read_sensor_file(const std::string& path);

}  // namespace bin_scenes
