/// Parts, sensors and the bin are copied field by field; report_message.cpp fills the report. Kinds that a message
/// writes as names are those of the request.
#include "scene_message.hpp"

#include <limits>

namespace bin_scenes {

namespace {

namespace msgs = bin_scenes_msgs;

// The message's constants are the library's enumeration, in its order.
static_assert(int(PartState::resting) == msgs::ScenePart::RESTING && int(PartState::moving) == msgs::ScenePart::MOVING);
static_assert(int(PartState::escaped) == msgs::ScenePart::ESCAPED && int(PartState::fixed) == msgs::ScenePart::FIXED);
static_assert(int(PartState::not_poured) == msgs::ScenePart::NOT_POURED);
static_assert(int(PartState::removed) == msgs::ScenePart::REMOVED);

msgs::ScenePart part_message(const ScenePart& part, const std::vector<Sensor>& sensors, const Frames& frames) {
  msgs::ScenePart message;
  message.id = part.id;
  message.frame_id = part_frame(part.id, frames.prefix);
  message.line = static_cast<std::uint32_t>(part.line);
  message.model = part.model;
  message.pose = pose_message(part.pose);
  message.velocity.linear = vector_message(part.velocity.linear);
  message.velocity.angular = vector_message(part.velocity.angular);
  message.distractor = part.distractor;
  message.state = static_cast<std::uint8_t>(part.state);
  for (const Sensor& sensor : sensors) {
    const auto seen = part.visible_fraction.find(sensor.name);
    message.visible_fraction.push_back(seen == part.visible_fraction.end() ? std::numeric_limits<double>::quiet_NaN()
                                                                           : seen->second);
  }
  return message;
}

}  // namespace

const char* name_of(Bin::Kind kind) {
  switch (kind) {
    case Bin::Kind::box:
      return "box";
    case Bin::Kind::mesh:
      return "mesh";
    case Bin::Kind::floor:
      return "floor";
    case Bin::Kind::none:
      return "none";
  }
  return "?";
}

bin_scenes_msgs::Bin bin_message(const Bin& bin) {
  msgs::Bin message;
  message.kind = name_of(bin.kind);
  message.inner_size = vector_message(bin.inner_size);
  message.wall_thickness = {bin.wall_thickness};
  message.mesh = bin.mesh;
  if (bin.unit) message.unit = name_of(*bin.unit);
  message.pose = pose_message(bin.pose);
  message.friction = {bin.friction};
  message.restitution = {bin.restitution};
  return message;
}

bin_scenes_msgs::Sensor sensor_message(const Sensor& sensor) {
  msgs::Sensor message;
  message.name = sensor.name;
  message.model = sensor.model;
  message.preset = sensor.preset;
  message.D.assign(sensor.distortion.begin(), sensor.distortion.end());
  message.width = static_cast<std::uint32_t>(sensor.width);
  message.height = static_cast<std::uint32_t>(sensor.height);
  message.fov = sensor.fov;
  message.K = sensor.k;
  if (sensor.pose) message.pose = pose_message(*sensor.pose);
  message.near = sensor.near;
  message.far = sensor.far;
  return message;
}

bin_scenes_msgs::Scene scene_message(const Scene& scene, const Request& request, const Frames& frames,
                                     const ros::Time& stamp) {
  msgs::Scene message;
  message.header.stamp = stamp;
  message.header.frame_id = frames.bin;
  message.seed = scene.seed;
  message.index = scene.index;
  message.request_sha256 = request.text_sha256;
  message.bin = bin_message(request.bin);
  for (const Sensor& sensor : scene.sensors) message.sensors.push_back(sensor_message(sensor));
  for (const ScenePart& part : scene.parts) message.parts.push_back(part_message(part, scene.sensors, frames));
  message.report = report_message(scene.report);
  return message;
}

}  // namespace bin_scenes
