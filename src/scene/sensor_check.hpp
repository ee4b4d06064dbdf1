/// Part of check(Request): the settings of sensor models.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>

namespace bin_scenes {

/// Throws an input Error at `key`.something for the first setting that makes no sense, whatever the sensor's model;
/// what only holds for some models is asked of those.
void check_sensor_models(const std::string& key, const Sensor& sensor);

}  // namespace bin_scenes
