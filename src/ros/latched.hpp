/// Publishes on a latched topic so that no subscriber keeps an older message, which plain roscpp does not guarantee
/// while subscribers connect.
#pragma once

#include <ros/publisher.h>

namespace bin_scenes {

/// roscpp sends a message to its subscribers and stores it for later ones in two steps (Publisher::publish, ros_comm
/// 1.15). A subscriber that connects between these steps receives the older message only. If the number of subscribers
/// has changed, the message is therefore published again, and earlier subscribers receive it twice. Subscribers in the
/// same process share the message without a copy, so that it must not be changed afterwards.
template <class MessagePtr>
void publish_latched(const ros::Publisher& publisher, const MessagePtr& message) {
  const auto subscribers = publisher.getNumSubscribers();
  publisher.publish(message);
  if (publisher.getNumSubscribers() != subscribers) publisher.publish(message);
}

}  // namespace bin_scenes
