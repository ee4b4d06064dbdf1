#include "bag_trace.hpp"

#include "bag_writer.hpp"

namespace bin_scenes {

BagTrace::BagTrace(std::string path, const Request& request, Frames frames)
    : path_(std::move(path)), frames_(std::move(frames)), begin_(bag_stamp(request.first)) {
  scene_.sensors = request.sensors;
  SceneBag::unharmed(path_, [&] {
    bag_ = std::make_unique<SceneBag>(path_, "");
    bag_->write(topic::tf_static, begin_, static_transforms(scene_, frames_, begin_), Latch::yes);
  });
}

void BagTrace::add(double time, const std::vector<ScenePart>& parts) {
  scene_.parts = parts;
  const ros::Time stamp = begin_ + ros::Duration(time);
  SceneBag::unharmed(path_, [&] { bag_->write(topic::tf, stamp, part_transforms(scene_, frames_, stamp), Latch::no); });
}

void BagTrace::finish() {
  SceneBag::unharmed(path_, [&] { bag_->close(); });
}

}  // namespace bin_scenes
