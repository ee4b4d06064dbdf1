#include "message_trace.hpp"

#include "bag_writer.hpp"
#include "mcap_writer.hpp"
#include "scene_bag.hpp"

#include <filesystem>

namespace bin_scenes {

namespace {

/// A bag that is written front to back, whose errors name it.
class BagRecording {
 public:
  explicit BagRecording(const std::string& path) : path_(path) {
    SceneBag::unharmed(path_, [&] { bag_ = std::make_unique<SceneBag>(path_, ""); });
  }
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message, Latch latch) {
    SceneBag::unharmed(path_, [&] { bag_->write(topic, stamp, message, latch); });
  }
  void close() {
    SceneBag::unharmed(path_, [&] { bag_->close(); });
  }

 private:
  std::string path_;
  std::unique_ptr<SceneBag> bag_;
};

/// @tparam Recording  has write(topic, stamp, message, latch) and close(); its file appears with close()
template <class Recording>
class MessageTrace final : public Trace {
 public:
  template <class... Arguments>
  explicit MessageTrace(const Request& request, const Arguments&... of_recording)
      : recording_(of_recording...), begin_(bag_stamp(request.first)) {
    scene_.sensors = request.sensors;
    write(topic::tf_static, begin_, static_transforms(scene_, frames_, begin_), Latch::yes);
  }
  bool shows_contacts() const override { return true; }
  void begin(const LoadedRequest& loaded) override {
    loaded_ = loaded;
    write(topic::markers, begin_, following_markers(loaded_, frames_, begin_), Latch::yes);
  }
  void add(const TraceSample& sample) override {
    scene_.parts = sample.parts;
    const ros::Time stamp = begin_ + ros::Duration(sample.time);
    write(topic::tf, stamp, part_transforms(scene_, frames_, stamp), Latch::no);
    write(topic::contacts, stamp, contact_markers(sample.contacts, loaded_, frames_, stamp), Latch::no);
  }
  void finish() override { recording_.close(); }

 private:
  template <class Message>
  void write(const char* name, const ros::Time& stamp, const Message& message, Latch latch) {
    recording_.write(recorded_name(name, ""), stamp, message, latch);
  }

  Recording recording_;
  Frames frames_;
  ros::Time begin_;
  Scene scene_;  ///< poses of the sample
  LoadedRequest loaded_;
};

}  // namespace

std::unique_ptr<Trace> message_trace(const std::string& path, const Request& request, McapProfile profile) {
  if (std::filesystem::path(path).extension() == ".mcap")
    return std::make_unique<MessageTrace<McapRecording>>(request, path, profile);
  return std::make_unique<MessageTrace<BagRecording>>(request, path);
}

}  // namespace bin_scenes
