/// --trace: states of every part over simulated time. The extension of the file says how they are written: .bag as
/// transforms (a build with ROS), all others as CSV.
#pragma once

#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

class Trace {
 public:
  virtual ~Trace() = default;
  /// @param time s since the scene began
  /// @param parts all of them, with id, pose (bin frame; not finite = not in the bin yet) and velocity
  virtual void add(double time, const std::vector<ScenePart>& parts) = 0;
  /// Only then the file is there.
  virtual void finish() = 0;
};

/// For the one scene of `request`. Throws an environment Error where no file can be written, before anything is
/// simulated.
std::unique_ptr<Trace> open_trace(const std::string& path, const Request& request);

using BagTraceMaker = std::function<std::unique_ptr<Trace>(const std::string& path, const Request& request)>;
/// Makes bags known; called by the part of the program that knows ROS (ros/bag_format.cpp).
void register_bag_trace(BagTraceMaker maker);

}  // namespace bin_scenes
