/// A bag file that appears either complete or not at all. Messages are written with the header that a recording of the
/// node would have, so that tools see no difference. Which messages are written is decided by the caller.
#pragma once

#include "bin_scenes/core/temporary.hpp"
#include "recording.hpp"

#include <rosbag/bag.h>
#include <boost/make_shared.hpp>

#include <functional>
#include <memory>
#include <string>

namespace bin_scenes {

/// An open bag under a temporary name, which close() renames.
class SceneBag {
 public:
  /// @param name_space  is put in front of relative topic names (recorded_name())
  SceneBag(const std::string& path, const std::string& name_space);
  ~SceneBag();
  SceneBag(const SceneBag&) = delete;
  SceneBag& operator=(const SceneBag&) = delete;

  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message, Latch latch) {
    namespace traits = ros::message_traits;
    // The header that a recording would have received from the node.
    auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = traits::datatype<Message>();
    (*header)["md5sum"] = traits::md5sum<Message>();
    (*header)["message_definition"] = traits::definition<Message>();
    (*header)["callerid"] = "/bin_scenes";
    (*header)["latching"] = latch == Latch::yes ? "1" : "0";
    bag_->write(recorded_name(topic, space_), stamp, message, header);
  }

  void close();

  /// Calls `work`. Turns an exception of rosbag into an environment Error that names `path`.
  static void unharmed(const std::string& path, const std::function<void()>& work);

 private:
  Temporary temporary_;
  std::string space_;
  std::unique_ptr<rosbag::Bag> bag_;
  bool closed_ = false;
};

}  // namespace bin_scenes
