/// Grippers by name: files of config/grippers with the keys of one item of a request's `grippers`.
#pragma once

#include "bin_scenes/scene/gripper.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Folder of the presets, beside that of the sensors'. Throws an environment Error.
std::string gripper_preset_directory();
/// Names of all presets, sorted.
std::vector<std::string> gripper_presets();
/// The gripper of a preset. Throws an input Error that names the nearest one.
Gripper gripper_preset(const std::string& name);

}  // namespace bin_scenes
