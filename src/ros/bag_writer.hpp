/// Writes a scene to a bag, without a ROS master. The bag holds the topics and types that a recording of the live node
/// would hold, all with one stamp. The messages are made in scene_message.hpp and its neighbours.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "topics.hpp"

#include <string>

namespace bin_scenes {

/// Returns the stamp of scene `index` in a bag: second `index` of the year 2025. It is fixed, because the same request
/// must give the same file; and it is not near 0, because tools treat such times as those of a simulated clock.
ros::Time bag_stamp(std::size_t index);

/// Writes one scene to a bag with the topics, types and latching of a recording of the live node; all messages have the
/// same stamp. The file is written under a temporary name and renamed. `images` is empty, or has one image for each
/// sensor. `name_space` is put in front of relative topic names; /tf and /tf_static stay as they are. Throws an
/// environment Error if the file cannot be written.
void write_bag(const std::string& path, const Scene& scene, const LoadedRequest& loaded,
               const std::vector<RangeImage>& images, const ros::Time& stamp, const Frames& frames = {},
               const std::string& name_space = "");

}  // namespace bin_scenes
