/// Writes a scene to an MCAP file for players of ROS 1 or ROS 2. Neither of them needs to run.
#pragma once

#include "bin_scenes/output/scene_writer.hpp"
#include "cdr.hpp"
#include "output/mcap.hpp"
#include "recording.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

/// The name, definition and checksum by which ROS 1 identifies a type of messages.
struct RosType {
  std::string name, definition;
};
template <class Message>
RosType ros_type_of() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::definition<Message>()};
}

/// Returns the channel of a topic, with the type's name and definition in the form of the profile.
McapChannel mcap_channel(McapProfile profile, const std::string& topic, const RosType& type, Latch latch,
                         const std::string& sender);
/// Adds to the file that qualities of service are written in the form of ROS 2 Humble, which rosbag2 needs to know.
void describe_profile(McapFile& file, McapProfile profile);

/// An MCAP file of ROS messages, as if a node of this program had sent them. With profile ros1, messages have the same
/// bytes as in a bag; with ros2, they are in the form of ROS 2. The file gets its name with close().
class McapRecording {
 public:
  McapRecording(const std::string& path, McapProfile profile) : file_(path, name_of(profile)), profile_(profile) {}
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message, Latch latch) {
    auto channel = channels_.find(topic);
    if (channel == channels_.end()) {
      const McapChannel made = mcap_channel(profile_, topic, ros_type_of<Message>(), latch, "/bin_scenes");
      channel = channels_.emplace(topic, file_.add_channel(made)).first;
    }
    const auto bytes = profile_ == McapProfile::ros2 ? cdr_bytes(message) : ros1_bytes(message);
    file_.write(channel->second, stamp.toNSec(), bytes.data(), bytes.size());
  }
  McapFile& file() { return file_; }
  void close() {
    describe_profile(file_, profile_);
    file_.close();
  }

 private:
  template <class Message>
  static std::vector<char> ros1_bytes(const Message& message) {
    std::vector<char> bytes(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, message);
    return bytes;
  }

  McapFile file_;
  McapProfile profile_;
  std::map<std::string, McapFile::ChannelId> channels_;
};

/// Writes the same topics in the same order as write_bag().
void write_mcap(const std::string& path, McapProfile profile, const Scene& scene, const LoadedRequest& loaded,
                const std::vector<RangeImage>& images, const ros::Time& stamp, const std::string& name_space = "");

}  // namespace bin_scenes
