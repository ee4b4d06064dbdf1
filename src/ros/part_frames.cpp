#include "part_frames.hpp"

#include "latched.hpp"
#include "topics.hpp"

#include <ros/console.h>

#include <algorithm>
#include <set>

namespace bin_scenes {

namespace {

/// Two stamps that differ for every consumer: tf2's Python interface rounds them to 0.24 us (double).
const ros::Duration least_step(0, 1000);

tf2_msgs::TFMessage stamped(tf2_msgs::TFMessage message, const ros::Time& stamp) {
  for (auto& transform : message.transforms) transform.header.stamp = stamp;
  return message;
}

/// What `before` shows and `now` does not, as children of `parent`.
tf2_msgs::TFMessage gone(const tf2_msgs::TFMessage& before, const tf2_msgs::TFMessage& now, const std::string& parent) {
  std::set<std::string> there;
  for (const auto& transform : now.transforms) there.insert(transform.child_frame_id);
  tf2_msgs::TFMessage message;
  for (const auto& transform : before.transforms) {
    if (there.count(transform.child_frame_id)) continue;
    message.transforms.push_back(transform);
    message.transforms.back().header.frame_id = parent;
  }
  return message;
}

}  // namespace

PartFrames::PartFrames(ros::NodeHandle node, std::string gone_frame, double rate, double span,
                       std::function<void()> clock_changed)
    : node_(std::move(node)),
      gone_frame_(std::move(gone_frame)),
      report_clock_change_(std::move(clock_changed)),
      span_(span),
      last_seen_(ros::Time::now()) {
  tf_ = node_.advertise<tf2_msgs::TFMessage>(topic::tf, 100, true);
  // Wall time, so that a clock that stands still, jumps or has not begun is seen.
  timer_ = node_.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { tick(); });
}

ros::Time PartFrames::show(tf2_msgs::TFMessage parts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::Time now = ros::Time::now();
  if (now.isZero()) {
    ROS_WARN_ONCE("use_sim_time is set, but no clock runs: scenes get stamps of almost 0 until /clock is published");
  }
  clock_changed(now);
  const ros::Time stamp = std::max(now, last_sent_ + least_step);
  const tf2_msgs::TFMessage past = stamped(gone(parts_, parts, gone_frame_), stamp);
  parts_ = stamped(std::move(parts), stamp);
  repeats_ = 0;
  last_sent_ = stamp;
  if (!past.transforms.empty()) tf_.publish(past);
  if (!past.transforms.empty() || !parts_.transforms.empty()) publish_latched(tf_, parts_);
  return stamp;
}

void PartFrames::set(double rate, double span) {
  timer_.setPeriod(ros::WallDuration(1.0 / rate));
  const std::lock_guard<std::mutex> lock(mutex_);
  span_ = span;
}

/// Stamps of the time before a jump say nothing any more.
bool PartFrames::clock_changed(const ros::Time& now) {
  const bool back = now < last_seen_, begun = last_seen_.isZero() && !now.isZero();
  if (back) last_sent_ = ros::Time();
  last_seen_ = now;
  return back || begun;
}

void PartFrames::tick() {
  bool changed = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::Time now = ros::Time::now();
    changed = clock_changed(now);
    if (!changed && !parts_.transforms.empty() && now > last_sent_) {
      const ros::Time scene = parts_.transforms.front().header.stamp;
      const ros::Duration before = least_step * ++repeats_;
      if (now - scene <= ros::Duration(span_) && scene.toSec() > before.toSec()) {
        tf2_msgs::TFMessage both = stamped(parts_, scene - before);
        const tf2_msgs::TFMessage present = stamped(parts_, now);
        both.transforms.insert(both.transforms.end(), present.transforms.begin(), present.transforms.end());
        publish_latched(tf_, both);
        last_sent_ = now;
      }
    }
  }
  if (changed) report_clock_change_();
}

}  // namespace bin_scenes
