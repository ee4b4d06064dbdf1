/// A latched topic whose message is made only when somebody wants it.
#pragma once

#include "latched.hpp"

#include <ros/advertise_options.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <string>

namespace bin_scenes {

/// A plain latched publisher would hand the message of an older scene to the first subscriber of a newer one that
/// nobody has looked at yet. This one forgets it.
template <class Message>
class LazyTopic {
 public:
  /// `make` gives the message of the present state, or none; called in `queue`'s thread only, where renew() has to be
  /// called too.
  LazyTopic(ros::NodeHandle node, std::string name, ros::CallbackQueueInterface* queue,
            std::function<std::optional<Message>()> make)
      : node_(std::move(node)), name_(std::move(name)), queue_(queue), make_(std::move(make)) {
    advertise();
  }
  LazyTopic(const LazyTopic&) = delete;
  LazyTopic& operator=(const LazyTopic&) = delete;

  bool wanted() const { return publisher_.getNumSubscribers() > 0; }

  /// There is something new to say: says it to those who listen, or else waits until somebody does.
  void renew() {
    const bool stale = published_;
    published_ = false;
    if (wanted()) {
      publish();
    } else if (stale) {
      publisher_.shutdown();
      advertise();
    }
  }

 private:
  void advertise() {
    const auto connected = [this](const ros::SingleSubscriberPublisher&) {
      if (!published_) publish();
    };
    auto options = ros::AdvertiseOptions::create<Message>(name_, 1, connected, ros::SubscriberStatusCallback(),
                                                          ros::VoidConstPtr(), queue_);
    options.latch = true;
    publisher_ = node_.advertise(options);
  }

  void publish() {
    const std::optional<Message> message = make_();
    if (!message) return;
    publish_latched(publisher_, *message);
    published_ = true;
  }

  ros::NodeHandle node_;
  std::string name_;
  ros::CallbackQueueInterface* queue_;
  std::function<std::optional<Message>()> make_;
  ros::Publisher publisher_;
  bool published_ = false;
};

}  // namespace bin_scenes
