/// A latched topic whose message is made only if there is a subscriber. Images and clouds use it, because rendering
/// them is the expensive part of a scene. Later subscribers receive the message of the present scene, never of an older
/// one.
#pragma once

#include "latched.hpp"

#include <ros/advertise_options.h>
#include <ros/node_handle.h>
#include <ros/single_subscriber_publisher.h>
#include <boost/make_shared.hpp>

#include <functional>
#include <optional>
#include <string>

namespace bin_scenes {

struct LazyTopicOptions {
  ros::NodeHandle node;
  std::string name;
  std::function<void()> connected;  ///< called in the queue of `node` when a subscriber arrives; it should call show()
  /// If true, subscribers in this process get the message without a copy. This class then stores the last message for
  /// later subscribers, because roscpp serialises each message of a topic that it latches itself.
  bool in_process = false;
};

/// A latched publisher of roscpp would send the message of an older scene to the first subscriber of a newer scene.
/// This class discards the message when the scene changes.
template <class Message>
class LazyTopic {
 public:
  /// @param make  returns the message of the present scene, or none. Only one thread at a time may use the object.
  LazyTopic(LazyTopicOptions options, std::function<std::optional<Message>()> make)
      : options_(std::move(options)), make_(std::move(make)) {
    advertise();
  }
  LazyTopic(const LazyTopic&) = delete;
  LazyTopic& operator=(const LazyTopic&) = delete;

  bool wanted() const { return publisher_.getNumSubscribers() > 0; }

  /// To be called when the scene has changed: publishes the new message if there are subscribers, or when one connects.
  void renew() {
    const bool stale = last_ != nullptr;
    last_.reset();
    show();
    if (!stale || last_ || options_.in_process) return;
    publisher_.shutdown();  // nothing else makes roscpp forget what it keeps for later subscribers
    advertise();
  }
  /// Publishes the message of the present scene if there is a subscriber and the message was not published yet.
  void show() {
    if (last_ || !wanted()) return;
    std::optional<Message> message = make_();
    if (!message) return;
    last_ = boost::make_shared<Message>(std::move(*message));
    publish_latched(publisher_, last_);
  }

 private:
  void advertise() {
    const auto connected = [this](const ros::SingleSubscriberPublisher& listener) {
      if (options_.in_process && last_) return listener.publish(*last_);
      options_.connected();
    };
    auto options = ros::AdvertiseOptions::create<Message>(options_.name, 1, connected, ros::SubscriberStatusCallback(),
                                                          ros::VoidConstPtr(), nullptr);
    options.latch = !options_.in_process;
    publisher_ = ros::NodeHandle(options_.node).advertise(options);
  }

  const LazyTopicOptions options_;
  std::function<std::optional<Message>()> make_;
  ros::Publisher publisher_;
  boost::shared_ptr<Message> last_;  ///< message published for the present scene; null: none yet
};

}  // namespace bin_scenes
