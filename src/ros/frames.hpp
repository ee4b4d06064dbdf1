/// The names of the TF frames, and the pose of the bin in the parent frame that the user chose. It also converts poses
/// to messages and makes the transforms of a scene; part_frames.hpp sends them.
#pragma once

#include "bin_scenes/scene/scene.hpp"

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <ros/time.h>
#include <tf2_msgs/TFMessage.h>

#include <string>

namespace bin_scenes {

struct Frames {
  std::string bin = "bin";       ///< frame of the bin: centre of the floor's top, z up
  std::string parent = "world";  ///< parent of the bin frame; empty: the bin frame is the root
  Pose bin_pose;                 ///< from the bin frame to `parent`
  std::string prefix;  ///< prefix of the frames of parts and sensors, such as "left/", which distinguishes several bins
};

std::string part_frame(int id, const std::string& prefix = "");  ///< such as "part_0007", with the prefix before it
/// Returns "<name>_optical_frame" with the prefix before it; graph_name() makes the name of the sensor valid in ROS.
std::string sensor_frame(const std::string& sensor, const std::string& prefix = "");

geometry_msgs::Pose pose_message(const Pose& pose);
geometry_msgs::Vector3 vector_message(const Vec3& v);
/// Returns the pose of a message. A quaternion of four zeros, which is the default of a message, is the identity.
Pose pose_from(const geometry_msgs::Pose& message);

/// Returns one transform from the bin frame to the part frame for each part with a finite pose.
tf2_msgs::TFMessage part_transforms(const Scene& scene, const Frames& frames, const ros::Time& stamp);
/// Returns the transforms that are the same for all scenes: parent to bin frame, and bin frame to each optical frame.
tf2_msgs::TFMessage static_transforms(const Scene& scene, const Frames& frames, const ros::Time& stamp);

}  // namespace bin_scenes
