/// Publishes on a latched topic so that no subscriber keeps an older message.
#pragma once

#include <ros/publisher.h>

namespace bin_scenes {

/// roscpp sends a message to those who listen and keeps it for those to come in two steps (Publisher::publish, ros_comm
/// 1.15). Who connects between the two is handed the message before and nothing after it; so those who came meanwhile
/// are published again, and who listens already then gets the message twice. Subscribers in the same process get the
/// message itself, without a copy: nobody may change it any more.
template <class MessagePtr>
void publish_latched(const ros::Publisher& publisher, const MessagePtr& message) {
  const auto subscribers = publisher.getNumSubscribers();
  publisher.publish(message);
  if (publisher.getNumSubscribers() != subscribers) publisher.publish(message);
}

}  // namespace bin_scenes
