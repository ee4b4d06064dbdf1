/// Materials: named optical surfaces. A material is a file of config/materials that contains the keys of `surface` in a
/// request. A request names it with the key `material`, and keys that are given after it override those of the
/// material.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the folder of the materials, which is beside the folder of the sensor presets. Throws an environment Error
/// if there is none.
std::string material_directory();
/// Returns the names of all materials, sorted.
std::vector<std::string> materials();
/// Returns the surface that a material describes. Throws an input Error that suggests the nearest name if the material
/// does not exist.
Surface material(const std::string& name);

}  // namespace bin_scenes
