/// Rigs: the sensors of published data sets under one name. A rig is a file of config/sensors/rigs that contains the
/// list `sensors` of a request.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>

namespace bin_scenes::config {

/// Puts the sensors of the rig that a request names in the place of its key `rig`. Returns what the rig's file says of
/// BOP's layout (keys of a plan's `bop`); not defined without a rig. Throws an input Error with the place of the key.
YAML::Node put_rig(YAML::Node request, const std::function<std::string(const std::string& path)>& where);

}  // namespace bin_scenes::config
