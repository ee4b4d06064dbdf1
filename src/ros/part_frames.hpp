/// The frames of a scene's parts on /tf.
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
  /// The timer is served in the queue of `node`. `clock_changed`: called there when the clock has gone back, or has
  /// begun; all that carries a stamp then needs a new one.
  PartFrames(ros::NodeHandle node, std::string gone_frame, double rate, double span,
             std::function<void()> clock_changed);

  /// Shows the parts of a scene: chooses its stamp, sends the transforms with it, and returns it. Stamps grow always,
  /// even if the clock does not advance or has not started.
  ros::Time show(tf2_msgs::TFMessage parts);
  /// (Hz), (s)
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
  ros::Time last_sent_;        ///< newest stamp on /tf; under another clock: none
  ros::Time last_seen_;        ///< last time of the clock
  ros::Publisher tf_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
