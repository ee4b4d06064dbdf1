/// Writes a scene to a bag, without a ROS master. The bag holds the topics and types that a recording of the live node
/// would hold, all with one stamp. The messages are made in scene_message.hpp and its neighbours.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "topics.hpp"

#include <string>

namespace bin_scenes {

/// Stamp of scene `index` in a bag: second `index` of the year 2025, because the same request has to give the same
/// file, and because tools take a time near 0 for a simulated clock.
ros::Time bag_stamp(std::size_t index);

/// Writes one scene to a bag of its own: the topics, types and latching of a recording of the live node, every message
/// with the same stamp. Written to a temporary name and renamed. `images`: none, or one for each sensor of the scene.
/// `name_space`: of the topics, as of a node; /tf and /tf_static stay where they are. Throws an environment Error if
/// the file cannot be written.
void write_bag(const std::string& path, const Scene& scene, const LoadedRequest& loaded,
               const std::vector<RangeImage>& images, const ros::Time& stamp, const Frames& frames = {},
               const std::string& name_space = "");

}  // namespace bin_scenes
