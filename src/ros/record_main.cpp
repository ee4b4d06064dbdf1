/// Records topics into an MCAP file, as `rosbag record` does into a bag:  record -o PREFIX TOPIC...
/// Parameter ~mcap says for whom: ros1 (default), any topic; ros2, topics of the types that this package publishes.
#include "bin_scenes/core/error.hpp"
#include "cdr.hpp"
#include "mcap_writer.hpp"
#include "messages.hpp"

#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include <csignal>
#include <ctime>
#include <iostream>
#include <map>
#include <set>
#include <tuple>

namespace bin_scenes {

namespace {

using topic_tools::ShapeShifter;

using ToCdr = std::vector<char> (*)(const ShapeShifter&);

template <class Message>
std::pair<const std::string, ToCdr> to_cdr() {
  return {ros::message_traits::datatype<Message>(),
          [](const ShapeShifter& any) { return cdr_bytes(*any.instantiate<Message>()); }};
}

const std::map<std::string, ToCdr>& published_types() {
  static const std::map<std::string, ToCdr> types = {
      to_cdr<bin_scenes_msgs::Scene>(),     to_cdr<sensor_msgs::CameraInfo>(),
      to_cdr<sensor_msgs::Image>(),         to_cdr<sensor_msgs::PointCloud2>(),
      to_cdr<std_msgs::Header>(),           to_cdr<tf2_msgs::TFMessage>(),
      to_cdr<visualization_msgs::Marker>(), to_cdr<visualization_msgs::MarkerArray>(),
  };
  return types;
}

class Recorder {
 public:
  Recorder(const std::string& path, McapProfile profile, const std::vector<std::string>& topics)
      : file_(path, name_of(profile)), profile_(profile) {
    constexpr std::uint32_t queue = 100;
    for (const std::string& name : topics) {
      const std::string topic = node_.resolveName(name);
      ros::SubscribeOptions options;
      options.initByFullCallbackType<const Event&>(topic, queue,
                                                   [this, topic](const Event& event) { add(topic, event); });
      subscribers_.push_back(node_.subscribe(options));
    }
  }

  void close() {
    describe_profile(file_, profile_);
    file_.close();
  }

 private:
  using Event = ros::MessageEvent<ShapeShifter const>;

  void add(const std::string& topic, const Event& event) {
    const ShapeShifter& message = *event.getConstMessage();
    const std::uint64_t time = event.getReceiptTime().toNSec();
    const auto type = published_types().find(message.getDataType());
    if (profile_ == McapProfile::ros2 && type == published_types().end()) return refuse(topic, message.getDataType());
    const McapFile::ChannelId id = channel(topic, event);
    if (profile_ == McapProfile::ros2) {
      const std::vector<char> bytes = type->second(message);
      return file_.write(id, time, bytes.data(), bytes.size());
    }
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream stream(bytes.data(), message.size());
    message.write(stream);
    file_.write(id, time, bytes.data(), bytes.size());
  }

  /// One for each sender, which may latch or not, and type.
  McapFile::ChannelId channel(const std::string& topic, const Event& event) {
    const ShapeShifter& message = *event.getConstMessage();
    const auto key = std::make_tuple(topic, event.getPublisherName(), message.getMD5Sum());
    const auto known = channels_.find(key);
    if (known != channels_.end()) return known->second;
    const auto& header = event.getConnectionHeader();
    const auto latching = header.find("latching");
    const Latch latch = latching != header.end() && latching->second == "1" ? Latch::yes : Latch::no;
    const RosType type = {message.getDataType(), message.getMessageDefinition()};
    return channels_[key] = file_.add_channel(mcap_channel(profile_, topic, type, latch, event.getPublisherName()));
  }

  void refuse(const std::string& topic, const std::string& type) {
    if (refused_.insert(topic).second)
      ROS_WARN("%s is not recorded: how ROS 2 defines %s is not known here; ~mcap ros1 takes every type", topic.c_str(),
               type.c_str());
  }

  ros::NodeHandle node_;
  McapFile file_;
  McapProfile profile_;
  std::map<std::tuple<std::string, std::string, std::string>, McapFile::ChannelId> channels_;
  std::set<std::string> refused_;
  std::vector<ros::Subscriber> subscribers_;
};

/// PREFIX_2025-01-31-13-59-59.mcap, as rosbag names bags.
std::string file_name(const std::string& prefix) {
  const std::time_t now = std::time(nullptr);
  char date[32];
  std::strftime(date, sizeof date, "_%Y-%m-%d-%H-%M-%S", std::localtime(&now));
  return prefix + date + ".mcap";
}

void record(std::vector<std::string> arguments) {
  if (arguments.size() < 3 || arguments[0] != "-o")
    throw input_error("expected -o PREFIX TOPIC...", "record", "name a prefix of the file, and topics");
  const std::string path = file_name(arguments[1]);
  arguments.erase(arguments.begin(), arguments.begin() + 2);
  const ros::NodeHandle parameters("~");
  const McapProfile profile =
      mcap_profile_of(parameters.param<std::string>("mcap", "ros1"), "parameter " + parameters.resolveName("mcap"));
  Recorder recorder(path, profile, arguments);
  ROS_INFO("Recording to %s, which appears when the recorder ends", path.c_str());
  ros::spin();
  recorder.close();
  std::cout << "recorded " << path << std::endl;
}

}  // namespace

}  // namespace bin_scenes

int main(int argc, char** argv) {
  ros::init(argc, argv, "record", ros::init_options::AnonymousName);
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });  // as roscpp does for SIGINT
  try {
    bin_scenes::record({argv + 1, argv + argc});
    return 0;
  } catch (const bin_scenes::Error& error) {
    std::cerr << "bin_scenes record: " << error.what() << std::endl;
    return error.kind() == bin_scenes::ErrorKind::input ? 2 : 3;
  } catch (const ros::InvalidNameException& error) {  // a topic, or a name that another is remapped to
    std::cerr << "bin_scenes record: " << error.what() << std::endl;
    return 2;
  }
}
