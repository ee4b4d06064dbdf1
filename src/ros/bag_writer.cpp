#include "bag_writer.hpp"

#include "bin_scenes/core/error.hpp"

#include <rosbag/bag.h>
#include <boost/make_shared.hpp>

#include <unistd.h>

#include <cstdio>
#include <memory>

namespace bin_scenes {

namespace {

enum class Latch { no, yes };

/// An open bag whose messages all have one stamp.
class SceneBag {
 public:
  SceneBag(const std::string& path, const ros::Time& stamp, std::string name_space)
      : bag_(std::make_unique<rosbag::Bag>(path, rosbag::bagmode::Write)),
        stamp_(stamp),
        space_(std::move(name_space)) {}
  /// A bag that is still open tries to close itself, and where the disk is full its destructor throws: the end of the
  /// process. Such a bag is given up instead.
  ~SceneBag() {
    if (!closed_) static_cast<void>(bag_.release());
  }
  SceneBag(const SceneBag&) = delete;
  SceneBag& operator=(const SceneBag&) = delete;

  template <class Message>
  void write(const std::string& topic, const Message& message, Latch latch) {
    namespace traits = ros::message_traits;
    // The header that a recording would have received from the node.
    auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = traits::datatype<Message>();
    (*header)["md5sum"] = traits::md5sum<Message>();
    (*header)["message_definition"] = traits::definition<Message>();
    (*header)["callerid"] = "/bin_scenes";
    (*header)["latching"] = latch == Latch::yes ? "1" : "0";
    bag_->write(topic.front() == '/' ? topic : space_ + "/" + topic, stamp_, message, header);
  }

  void close() {
    bag_->close();
    closed_ = true;
  }

 private:
  std::unique_ptr<rosbag::Bag> bag_;
  ros::Time stamp_;
  const std::string space_;  ///< "/cell", ""
  bool closed_ = false;
};

}  // namespace

ros::Time bag_stamp(std::size_t index) {
  constexpr std::uint32_t year_2025 = 1735689600;  // s since the epoch, to its begin
  return ros::Time(year_2025 + static_cast<std::uint32_t>(index), 0);
}

void write_bag(const std::string& path, const Scene& scene, const Request& request,
               const std::vector<RangeImage>& images, const std::vector<PartModelPtr>& parts,
               const PartModelPtr& bin_model, const ros::Time& stamp, const Frames& frames, const std::string& name_space) {
  const SceneMessages messages = scene_messages(scene, request, parts, bin_model, frames, stamp);
  std::string space = name_space.empty() || name_space[0] == '/' ? name_space : "/" + name_space;
  while (!space.empty() && space.back() == '/') space.pop_back();
  const std::string unfinished = path + "." + std::to_string(getpid()) + ".tmp";
  try {
    SceneBag bag(unfinished, stamp, space);
    bag.write(topic::tf_static, messages.statics, Latch::yes);  // first, so that a player knows the frames at once
    bag.write(topic::tf, messages.parts, Latch::yes);
    bag.write(topic::scene, messages.scene, Latch::yes);
    bag.write(topic::markers, messages.markers, Latch::yes);
    for (std::size_t i = 0; i < images.size(); ++i) {
      const ImageMessages image = image_messages(images[i], stamp, frames.prefix);
      const auto name = [&](const char* relative) { return topic::of_sensor(relative, images[i].sensor.name, images.size()); };
      bag.write(name(topic::points), image.points, Latch::yes);
      bag.write(name(topic::depth), image.depth, Latch::yes);
      bag.write(name(topic::camera_info), image.camera_info, Latch::yes);
      bag.write(name(topic::labels), image.labels, Latch::yes);
      bag.write(name(topic::validity), image.validity, Latch::yes);
    }
    bag.write(topic::acquisition_done, messages.done, Latch::no);
    bag.close();
    if (std::rename(unfinished.c_str(), path.c_str()) != 0) throw rosbag::BagIOException("cannot be renamed");
  } catch (const rosbag::BagException& error) {
    std::remove(unfinished.c_str());
    throw environment_error(std::string("the bag cannot be written: ") + error.what(), path,
                            "check that the directory exists, is writable, and has room");
  }
}

}  // namespace bin_scenes
