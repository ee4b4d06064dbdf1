/// Surfaces by name: files of config/materials with the keys of a request's `surface`.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Folder of the materials, beside that of the sensor presets. Throws an environment Error.
std::string material_directory();
/// Names of all materials, sorted.
std::vector<std::string> materials();
/// The surface of a material. Throws an input Error that names the nearest one.
Surface material(const std::string& name);

}  // namespace bin_scenes
