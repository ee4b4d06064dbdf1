/// The name of a sensor in ROS topics and TF frames. Request files allow more characters than ROS does; this function
/// makes the valid name that all outputs share.
#pragma once

#include <string>

namespace bin_scenes {

/// Returns the name of a sensor for topics and TF frames: a hyphen becomes an underscore, and a name that does not
/// begin with a letter gets the prefix "sensor_". The key `frame` of scene.json contains the same name.
std::string graph_name(const std::string& sensor);

}  // namespace bin_scenes
