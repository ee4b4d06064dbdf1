/// Reads the ROS parameters of the node. The names and defaults of the parameters are documented at the members of
/// Settings and in docs/use/ros.md.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "frames.hpp"

#include <ros/node_handle.h>

#include <string>

namespace bin_scenes {

struct Settings {
  /// ~bin_frame ("bin"), ~parent_frame ("world"; "" = the bin frame is the root of the tree) and ~bin_pose
  /// ([x, y, z, qx, qy, qz, qw] in m, identity): where the bin stands in the user's cell. ~frame_prefix ("") goes
  /// before the names of all frames but the parent's.
  Frames frames;
  /// ~tf_rate (Hz, 10) and ~tf_span (s, 8): how often and how long after a scene its part frames are sent again under
  /// the present time. Consumers whose tf2 buffer is shorter than the span lose the scene's own stamp
  /// (part_frames.hpp).
  double tf_rate = 10.0, tf_span = 8.0;
  /// ~publish_rate (Hz, 0): > 0 publishes everything again at this rate, each time under a new stamp.
  double publish_rate = 0.0;
  /// ~model_roots (list of folders; default: the package's models): models and request files outside of them are
  /// refused. Relative paths are searched in each of them.
  PathRules paths;
  /// ~request (path, ""): a request file to make a scene from at the start. Its folder is added to the model roots.
  std::string request;
  /// ~goals ("queue"; or "preempt"): whether a new goal waits for the earlier ones or cancels them.
  bool preempt = false;
  /// ~queue_size (16): jobs that may wait; further ones are refused.
  int queue_size = 16;
  /// ~scenes_ahead (0): scenes made ahead for next_scene, in a thread of their own.
  int scenes_ahead = 0;
  /// ~rgb (false): clouds carry a field `rgb`, the colour of each part's marker.
  bool rgb = false;
};

/// `frame_prefix`: if ~frame_prefix is not set. Throws an input Error for a parameter of the wrong type or without
/// sense.
Settings read_settings(const ros::NodeHandle& params, const std::string& frame_prefix);

}  // namespace bin_scenes
