/// Expands the key `views` of a sensor into one sensor for each view, so that the rest of the program knows sensors
/// only. It also provides the pose of a camera that looks at a point.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <functional>
#include <string>

namespace bin_scenes::config {

/// The optical frame at `distance` from the target, image right = bin x and image up = bin y where tilt and roll are 0.
Pose looking_at(const Vec3& target, double distance, double tilt, double turn, double roll);

/// Puts a sensor for each of its views in a sensor's place. Throws an input Error with the place of the key.
void spell_out_views(Request& request, const std::function<std::string(const std::string& path)>& where,
                     const std::function<bool(const std::string& path)>& given);

}  // namespace bin_scenes::config
