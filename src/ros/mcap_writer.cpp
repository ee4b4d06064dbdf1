#include "mcap_writer.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "cdr.hpp"

namespace bin_scenes {

namespace {

/// What rosbag2 reads as the qualities of service of a publisher. Numbers are understood by Humble and later;
/// durability 1 is transient_local, which stands for a latched topic, 2 volatile.
std::string quality_of_service(Latch latch) {
  const std::string endless = "{sec: 9223372036, nsec: 854775807}";
  return std::string("- history: 1\n  depth: 1\n  reliability: 1\n  durability: ") + (latch == Latch::yes ? "1" : "2") +
         "\n  deadline: " + endless + "\n  lifespan: " + endless +
         "\n  liveliness: 1\n  liveliness_lease_duration: " + endless + "\n  avoid_ros_namespace_conventions: false\n";
}

template <class Message>
void write(McapFile& file, McapProfile profile, const McapChannel& channel, std::uint64_t time,
           const Message& message) {
  const McapFile::ChannelId id = file.add_channel(channel);
  if (profile == McapProfile::ros2) {
    const std::vector<char> bytes = cdr_bytes(message);
    return file.write(id, time, bytes.data(), bytes.size());
  }
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  file.write(id, time, bytes.data(), bytes.size());
}

McapTexts facts(const Scene& scene, const Request& request) {
  return {{"accepted", scene.report.accepted ? "true" : "false"},
          {"index", std::to_string(scene.index)},
          {"request_sha256", request.text_sha256},
          {"seed", std::to_string(scene.seed)},
          {"solver", scene.report.solver}};
}

}  // namespace

McapChannel mcap_channel(McapProfile profile, const std::string& topic, const RosType& type, Latch latch,
                         const std::string& sender) {
  if (profile == McapProfile::ros2) {
    return {topic,
            "cdr",
            {ros2_type(type.name), "ros2msg", ros2_definition(type.name, type.definition)},
            {{"offered_qos_profiles", quality_of_service(latch)}}};
  }
  return {topic,
          "ros1",
          {type.name, "ros1msg", type.definition},
          {{"callerid", sender}, {"latching", latch == Latch::yes ? "true" : "false"}}};
}

void describe_profile(McapFile& file, McapProfile profile) {
  if (profile == McapProfile::ros2) file.add_metadata("rosbag2", {{"ROS_DISTRO", "humble"}});
}

void write_mcap(const std::string& path, McapProfile profile, const Scene& scene, const LoadedRequest& loaded,
                const std::vector<RangeImage>& images, const ros::Time& stamp, const std::string& name_space) {
  const std::uint64_t time = stamp.toNSec();
  McapFile file(path, name_of(profile));
  for_each_message(scene, loaded, images, stamp, {}, [&](const std::string& name, const auto& message, Latch latch) {
    using Message = std::decay_t<decltype(message)>;
    const std::string topic = recorded_name(name, name_space);
    write(file, profile, mcap_channel(profile, topic, ros_type_of<Message>(), latch, "/bin_scenes"), time, message);
  });
  Request one = loaded.request;
  one.scenes = 1;
  one.first = scene.index;
  file.attach("request.yaml", "application/yaml", time, write_request(one));
  file.attach("scene.json", "application/json", time, scene_json(scene, loaded, images));
  file.add_metadata("bin_scenes", facts(scene, loaded.request));
  describe_profile(file, profile);
  file.close();
}

}  // namespace bin_scenes
