/// Parameters of the node.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "frames.hpp"

#include <ros/node_handle.h>

#include <string>

namespace bin_scenes {

struct Settings {
  /// ~bin_frame ("bin"), ~parent_frame ("world"; "" = the bin frame is the root of the tree) and ~bin_pose
  /// ([x, y, z, qx, qy, qz, qw] in m, identity): where the bin stands in the user's cell.
  Frames frames;
  /// ~tf_rate (Hz, 10): how often part frames are sent again. Lower = less traffic, but a late listener waits longer
  /// for them, and a removed part's frame looks alive longer.
  double tf_rate = 10.0;
  /// ~model_roots (list of folders; default: the package's models): models and request files outside of them are
  /// refused. Relative model paths of a request without a file start at the first.
  PathRules paths;
  /// ~request (path, ""): a request file to make a scene from at the start. Its folder is added to the model roots.
  std::string request;
};

/// Throws an input Error for a parameter of the wrong type or without sense.
Settings read_settings(const ros::NodeHandle& params);

}  // namespace bin_scenes
