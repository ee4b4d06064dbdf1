/// Rigs: the sensors of published data sets under one name. A rig is a file of config/sensors/rigs that contains the
/// list `sensors` of a request.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>

namespace bin_scenes::config {

/// Replaces the key `rig` of a request by the sensors of that rig. Returns the keys of a plan's `bop` that the file of
/// the rig states; undefined if the request names no rig. Throws an input Error with the place of the key.
YAML::Node put_rig(YAML::Node request, const std::function<std::string(const std::string& path)>& where);

}  // namespace bin_scenes::config
