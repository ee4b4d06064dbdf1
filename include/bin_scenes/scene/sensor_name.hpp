/// The name of a sensor in topics and TF frames.
#pragma once

#include <string>

namespace bin_scenes {

/// A sensor's name as its topics and TF frames spell it, by the rules of ROS names: a hyphen becomes an underscore, and
/// what does not begin with a letter is preceded by "sensor_". The same in scene.json (`frame`).
std::string graph_name(const std::string& sensor);

}  // namespace bin_scenes
