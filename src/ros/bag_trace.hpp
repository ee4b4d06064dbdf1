/// A scene over simulated time as a bag, without a ROS master.
#pragma once

#include "bin_scenes/output/trace.hpp"
#include "frames.hpp"
#include "scene_bag.hpp"

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// /tf_static once, then one message a sample on /tf: bin frame -> part frame of each part that is in. Stamps are those
/// of the scene's other bag (bag_stamp()) plus the simulated time. The file appears with finish().
class BagTrace final : public Trace {
 public:
  /// Throws an environment Error where no file can be written.
  BagTrace(std::string path, const Request& request, Frames frames = {});
  void add(double time, const std::vector<ScenePart>& parts) override;
  void finish() override;

 private:
  std::string path_;
  Frames frames_;
  ros::Time begin_;
  Scene scene_;  ///< poses of the sample
  std::unique_ptr<SceneBag> bag_;
};

}  // namespace bin_scenes
