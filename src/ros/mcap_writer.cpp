#include "mcap_writer.hpp"

#include "bin_scenes/config/request_reader.hpp"

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
  McapRecording recording(path, profile);
  for_each_message(scene, loaded, images, stamp, {}, [&](const std::string& name, const auto& message, Latch latch) {
    recording.write(recorded_name(name, name_space), stamp, message, latch);
  });
  Request one = loaded.request;
  one.scenes = 1;
  one.first = scene.index;
  const std::uint64_t time = stamp.toNSec();
  recording.file().attach("request.yaml", "application/yaml", time, write_request(one));
  recording.file().attach("scene.json", "application/json", time, scene_json(scene, loaded, images));
  recording.file().add_metadata("bin_scenes", facts(scene, loaded.request));
  recording.close();
}

}  // namespace bin_scenes
