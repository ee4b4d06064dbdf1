/// A scene as an MCAP file, for players of ROS 1 or ROS 2; neither need run.
#pragma once

#include "bin_scenes/output/scene_writer.hpp"
#include "recording.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// As write_bag(): the same topics in the same order. Profile ros1 has the bytes of the bag's messages, ros2 the same
/// messages as ROS 2 has them. Attached are scene.json, and as request.yaml what makes this scene again.
void write_mcap(const std::string& path, McapProfile profile, const Scene& scene, const LoadedRequest& loaded,
                const std::vector<RangeImage>& images, const ros::Time& stamp, const std::string& name_space = "");

}  // namespace bin_scenes
