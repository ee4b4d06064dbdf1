#include "frames.hpp"

#include "bin_scenes/scene/sensor_name.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "core/formatted.hpp"

#include <geometry_msgs/TransformStamped.h>

namespace bin_scenes {

namespace {

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child, const Pose& pose,
                                          const ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform.translation.x = pose.position.x();
  message.transform.translation.y = pose.position.y();
  message.transform.translation.z = pose.position.z();
  message.transform.rotation = pose_message(pose).orientation;
  return message;
}

}  // namespace

std::string part_frame(int id, const std::string& prefix) {
  return prefix + formatted("part_%04d", id);
}

std::string sensor_frame(const std::string& sensor, const std::string& prefix) {
  return prefix + graph_name(sensor) + "_optical_frame";
}

geometry_msgs::Vector3 vector_message(const Vec3& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::Pose pose_message(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.position.x();
  message.position.y = pose.position.y();
  message.position.z = pose.position.z();
  message.orientation.x = pose.orientation.x();
  message.orientation.y = pose.orientation.y();
  message.orientation.z = pose.orientation.z();
  message.orientation.w = pose.orientation.w();
  return message;
}

Pose pose_from(const geometry_msgs::Pose& message) {
  Pose pose;
  pose.position = Vec3(message.position.x, message.position.y, message.position.z);
  const auto& q = message.orientation;
  if (q.x != 0.0 || q.y != 0.0 || q.z != 0.0 || q.w != 0.0) pose.orientation = Quat(q.w, q.x, q.y, q.z);
  return pose;
}

tf2_msgs::TFMessage part_transforms(const Scene& scene, const Frames& frames, const ros::Time& stamp) {
  tf2_msgs::TFMessage message;
  for (const ScenePart& part : scene.parts) {
    if (!part.pose.finite()) continue;  // tf2 refuses NaN; such a part is listed in the scene message
    message.transforms.push_back(transform(frames.bin, part_frame(part.id, frames.prefix), part.pose, stamp));
  }
  return message;
}

tf2_msgs::TFMessage static_transforms(const Scene& scene, const Frames& frames, const ros::Time& stamp) {
  tf2_msgs::TFMessage message;
  if (!frames.parent.empty()) {
    message.transforms.push_back(transform(frames.parent, frames.bin, frames.bin_pose, stamp));
  }
  for (const Sensor& sensor : scene.sensors) {
    if (!sensor.pose) continue;
    const auto place = [&](const std::string& frame, const Pose& pose) {
      message.transforms.push_back(transform(frames.bin, frames.prefix + graph_name(sensor.name) + frame, pose, stamp));
    };
    place("_optical_frame", *sensor.pose);
    const SensorModel& model = sensor_model(sensor.model);
    if (model.projector && sensor.projector.pose) place("_projector_optical_frame", *sensor.projector.pose);
    if (model.laser && sensor.laser.pose) place("_laser_frame", *sensor.laser.pose);
  }
  return message;
}

}  // namespace bin_scenes
