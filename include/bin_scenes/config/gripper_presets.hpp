/// Presets of grippers. A preset is a file of config/grippers that contains the keys of one item of `grippers` in a
/// request. A request names a preset with the key `preset`, and keys that are given beside it override those of the
/// preset.
#pragma once

#include "bin_scenes/scene/gripper.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the folder of the presets, which is beside the folder of the sensor presets. Throws an environment Error if
/// there is none.
std::string gripper_preset_directory();
/// Returns the names of all presets, sorted.
std::vector<std::string> gripper_presets();
/// Returns the gripper that a preset describes. Throws an input Error that suggests the nearest name if the preset does
/// not exist.
Gripper gripper_preset(const std::string& name);

}  // namespace bin_scenes
