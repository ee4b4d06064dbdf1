/// Writes the trace of a scene (output/trace.hpp) as ROS messages to a .bag or .mcap file, without a ROS master.
/// Contacts are markers.
#pragma once

#include "bin_scenes/output/trace.hpp"

#include <memory>
#include <string>

namespace bin_scenes {

/// Returns a trace that writes a .bag or .mcap file, by the extension of `path`. At the start it writes /tf_static and
/// the markers of the bin and the parts, which follow their frames. Each sample has on /tf the frames of the parts that
/// have entered, and on `contacts` the contacts of the step (contact_markers()). Stamps are bag_stamp() plus the
/// simulated time, for `rosbag play --clock` and Foxglove. Throws an environment Error if the file cannot be written.
std::unique_ptr<Trace> message_trace(const std::string& path, const Request& request, McapProfile profile);

}  // namespace bin_scenes
