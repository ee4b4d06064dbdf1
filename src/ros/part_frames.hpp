/// Publishes the frames of the parts of a scene on /tf.
///
/// A tf2 buffer forgets what is older than its length (10 s unless set otherwise) before the newest stamp of a frame,
/// and warns if one stamp comes twice. Transforms that are sent again and again under the present time would thus push
/// out the stamp of the scene, under which its cloud is looked up. Therefore:
///
///     scene shown     its stamp S
///     at a set rate   S less some microseconds, and the present time, in one message; for a span below the buffers'
///                     length, then no more
///     late listener   the last of these messages, which is latched: it has S between its two stamps
///     gone parts      once, as children of a frame that nothing connects to the bin: lookups of them fail at once
///
/// So a part is found at S, at "the latest" (time 0), and at the present time within the span.
#pragma once

#include "frames.hpp"

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

namespace bin_scenes {

class PartFrames {
 public:
  /// The timer runs in the queue of `node`. There, `clock_changed` is called when the ROS clock has jumped back or has
  /// started, so that all messages need a new stamp.
  PartFrames(ros::NodeHandle node, std::string gone_frame, double rate, double span,
             std::function<void()> clock_changed);

  /// Shows the parts of a scene: chooses the stamp, publishes the transforms with it, and returns it. Each stamp is
  /// later than the one before, even if the clock does not advance or has not started.
  ros::Time show(tf2_msgs::TFMessage parts);
  /// Sets the rate (Hz) at which transforms are repeated, and the time after a scene (s) for which they are repeated.
  void set(double rate, double span);

 private:
  void tick();
  bool clock_changed(const ros::Time& now);

  ros::NodeHandle node_;
  const std::string gone_frame_;
  const std::function<void()> report_clock_change_;
  std::mutex mutex_;
  double span_;
  tf2_msgs::TFMessage parts_;  ///< transforms with the stamp of the scene
  std::uint32_t repeats_ = 0;  ///< how often the transforms of this scene were repeated
  ros::Time last_sent_;        ///< newest stamp on /tf; zero after the clock has jumped back
  ros::Time last_seen_;        ///< time of the clock at the last call
  ros::Publisher tf_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
