/// A master that is started again knows nobody. roscpp tells a master once what its process offers, and never again:
/// its connections go on, but nobody new finds it. This tells such a master anew.
#pragma once

#include "thread_queue.hpp"

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

namespace bin_scenes {

class MasterWatch {
 public:
  /// Asks the master once a second, in a thread of its own, whether it knows this process; one a process is enough.
  MasterWatch();
  ~MasterWatch();

 private:
  ThreadQueue thread_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
