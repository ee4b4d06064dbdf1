#include "scene_bag.hpp"

#include "bin_scenes/core/error.hpp"

namespace bin_scenes {

SceneBag::SceneBag(const std::string& path, const std::string& name_space)
    : temporary_(path),
      space_(name_space),
      bag_(std::make_unique<rosbag::Bag>(temporary_.path(), rosbag::bagmode::Write)) {}

/// A bag that is still open tries to close itself, and where the disk is full its destructor throws: the end of the
/// process. Such a bag is given up instead.
SceneBag::~SceneBag() {
  if (closed_) return;
  static_cast<void>(bag_.release());
}

void SceneBag::close() {
  bag_->close();
  closed_ = true;
  temporary_.commit();
}

void SceneBag::unharmed(const std::string& path, const std::function<void()>& work) {
  try {
    work();
  } catch (const rosbag::BagException& error) {
    throw environment_error(std::string("the bag cannot be written: ") + error.what(), path,
                            "check that the directory exists, is writable, and has room");
  }
}

}  // namespace bin_scenes
