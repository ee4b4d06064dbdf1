/// Expands the key `views` of a sensor into one sensor for each view, so that the rest of the program knows sensors
/// only. It also provides the pose of a camera that looks at a point.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <functional>
#include <string>

namespace bin_scenes::config {

/// Returns the pose of a camera's optical frame. With tilt = roll = 0, image right is bin x, and image up is bin y.
Pose looking_at(const Vec3& target, double distance, double tilt, double turn, double roll);

/// Replaces each sensor that has views by one sensor for each view. Throws an input Error with the place of the key.
void spell_out_views(Request& request, const std::function<std::string(const std::string& path)>& where,
                     const std::function<bool(const std::string& path)>& given);

}  // namespace bin_scenes::config
