/// What the command line sees of the ROS rim; no header of ROS comes with it.
#pragma once

namespace bin_scenes {

/// Makes `--formats bag` known (output/scene_writer.hpp).
void install_bag_writer();

}  // namespace bin_scenes
