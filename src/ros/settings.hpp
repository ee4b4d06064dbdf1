/// Reads the ROS parameters of the node. The names and defaults of the parameters are documented at the members of
/// Settings and in docs/use/ros.md.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "frames.hpp"

#include <ros/node_handle.h>

#include <string>

namespace bin_scenes {

struct Settings {
  /// ~bin_frame ("bin"), ~parent_frame ("world"; "": the bin frame is the root of the tree), ~bin_pose ([x, y, z, qx,
  /// qy, qz, qw] in m, default identity): pose of the bin in the parent frame. ~frame_prefix ("") is put before the
  /// names of all frames except the parent frame.
  Frames frames;
  /// ~tf_rate (Hz, 10) and ~tf_span (s, 8): the rate at which the part frames of a scene are sent again with the
  /// present time, and for how long. If the tf2 buffer of a consumer is shorter than the span, it loses the transforms
  /// with the stamp of the scene (part_frames.hpp).
  double tf_rate = 10.0, tf_span = 8.0;
  /// ~publish_rate (Hz, 0): if > 0, all topics are published again at this rate, each time with a new stamp.
  double publish_rate = 0.0;
  /// ~model_roots (list of folders; default: the models of the package): models and request files outside of these
  /// folders are refused. Relative paths are searched in each of them.
  PathRules paths;
  /// ~request (path, ""): request file of the scene that is made at the start. Its folder is added to the model roots.
  std::string request;
  /// ~goals ("queue"; or "preempt"): whether a new goal waits for the earlier ones or cancels them.
  bool preempt = false;
  /// ~queue_size (16): largest number of waiting jobs; further jobs are refused.
  int queue_size = 16;
  /// ~scenes_ahead (0): number of scenes that are made in advance for next_scene, in a separate thread.
  int scenes_ahead = 0;
  /// ~rgb (false): whether clouds have a field `rgb` with the colour of each part's marker.
  bool rgb = false;
};

/// Reads the parameters. `frame_prefix` is used if ~frame_prefix is not set. Throws an input Error for a parameter of
/// the wrong type or with an invalid value.
Settings read_settings(const ros::NodeHandle& params, const std::string& frame_prefix);

}  // namespace bin_scenes
