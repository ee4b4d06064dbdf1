/// Registers this process again with a ROS master that was restarted. roscpp registers topics and services only once:
/// after a restart of the master, existing connections continue, but new clients would not find this process.
#pragma once

#include "thread_queue.hpp"

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <cstddef>
#include <string>
#include <vector>

namespace bin_scenes {

class MasterWatch {
 public:
  /// Asks the master once a second in a separate thread whether it knows this process. One object per process suffices.
  MasterWatch();
  ~MasterWatch();

 private:
  void ask_master();

  /// Services of this process. The list is renewed every ten seconds, so that newer services may be missing.
  std::vector<std::string> services_;
  std::size_t asked_ = 0;  ///< number of requests to the master
  ThreadQueue thread_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
