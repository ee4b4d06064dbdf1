/// Publishes the frames of the parts of a scene on /tf.
///
/// A tf2 buffer stores the transforms of a frame for a fixed time (10 s by default) before the newest stamp, and warns
/// if a stamp is repeated. If transforms were sent repeatedly with the present time, the stamp of the scene, at which
/// its cloud is looked up, would soon be too old for the buffer. Therefore:
///
///     new scene         transforms with its stamp S
///     at a fixed rate   one message with transforms at some microseconds before S and at the present time; it ends
///                       after a span that is shorter than the buffers
///     late subscriber   the last of these messages, which is latched; S is between its two stamps
///     removed parts     once, as children of a frame without connection to the bin, so that lookups fail at once
///
/// A part is thus found at S, at the latest time (time 0), and at the present time within the span.
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
