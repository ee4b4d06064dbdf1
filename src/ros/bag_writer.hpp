/// A scene as a bag, without a ROS master.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "topics.hpp"

#include <string>

namespace bin_scenes {

/// Stamp of scene `index` in a bag: second index + 1, because the same request has to give the same file, and because
/// ROS reads 0 as "no time".
ros::Time bag_stamp(std::size_t index);

/// Writes one scene to a bag of its own: the topics, types and latching of a recording of the live node, every message
/// with the same stamp. Written to a temporary name and renamed. `images`: none, or one for each sensor of the scene.
/// Throws an environment Error if the file cannot be written.
void write_bag(const std::string& path, const Scene& scene, const Request& request,
               const std::vector<RangeImage>& images, const std::vector<PartModelPtr>& parts,
               const PartModelPtr& bin_model, const ros::Time& stamp, const Frames& frames = {});

}  // namespace bin_scenes
