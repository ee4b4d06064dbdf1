/// Writes the trace of a scene (output/trace.hpp) as ROS messages to a .bag or .mcap file, without a ROS master.
/// Contacts are markers.
#pragma once

#include "bin_scenes/output/trace.hpp"

#include <memory>
#include <string>

namespace bin_scenes {

/// Once: /tf_static, and on `markers` the bin and the parts, which follow their frames. With each sample: on /tf the
/// frame of each part that is in, and on `contacts` the contacts of the step (contact_markers()). Stamps are those of
/// the scene's other bag (bag_stamp()) plus the simulated time, for `rosbag play --clock` and RViz, or for Foxglove.
/// The extension of `path` chooses the kind of file. Throws an environment Error where no file can be written.
std::unique_ptr<Trace> message_trace(const std::string& path, const Request& request, McapProfile profile);

}  // namespace bin_scenes
