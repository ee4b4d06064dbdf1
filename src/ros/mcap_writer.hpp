/// A scene as an MCAP file, for players of ROS 1 or ROS 2; neither need run.
#pragma once

#include "bin_scenes/output/scene_writer.hpp"
#include "output/mcap.hpp"
#include "recording.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// What ROS 1 knows of a type of messages.
struct RosType {
  std::string name, definition;
};
template <class Message>
RosType ros_type_of() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::definition<Message>()};
}

/// `type` in a file of that profile. `sender`: name of the node.
McapChannel mcap_channel(McapProfile profile, const std::string& topic, const RosType& type, Latch latch,
                         const std::string& sender);
/// States for rosbag2 that qualities of service are written as Humble does.
void describe_profile(McapFile& file, McapProfile profile);

/// As write_bag(): the same topics in the same order. Profile ros1 has the bytes of the bag's messages, ros2 the same
/// messages as ROS 2 has them. Attached are scene.json, and as request.yaml what makes this scene again.
void write_mcap(const std::string& path, McapProfile profile, const Scene& scene, const LoadedRequest& loaded,
                const std::vector<RangeImage>& images, const ros::Time& stamp, const std::string& name_space = "");

}  // namespace bin_scenes
