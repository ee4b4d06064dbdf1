/// Presets of sensors, surfaces and grippers. A preset is a file of config/sensors, config/materials or
/// config/grippers. It contains the keys of an item of `sensors`, of `surface`, or of an item of `grippers` in a
/// request. A request names a preset with the key `preset` (a surface: `material`), and keys that are given beside it
/// override those of the preset.
///
/// The folder of the sensors is $BIN_SCENES_SENSORS if that is set, otherwise the folder of the source tree or of the
/// installation; the other folders are beside it. All functions throw an environment Error if there is no such folder.
#pragma once

#include "bin_scenes/scene/gripper.hpp"
#include "bin_scenes/scene/request.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Return the names of all presets of a kind, sorted.
std::vector<std::string> sensor_presets();
std::vector<std::string> materials();
std::vector<std::string> gripper_presets();
/// Return what the preset of that name describes. Throw an input Error that suggests the nearest name if the preset
/// does not exist.
Sensor sensor_preset(const std::string& name);
Surface material(const std::string& name);
Gripper gripper_preset(const std::string& name);
/// Returns a sensor with the values of a file in the format of the presets. Throws an input Error.
Sensor read_sensor_file(const std::string& path);

}  // namespace bin_scenes
