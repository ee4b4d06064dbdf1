/// Makes `--formats bag,mcap` (output/scene_writer.hpp) and `--trace FILE.bag|.mcap` (output/trace.hpp) known to the
/// program that this file is linked into.
#include "bag_writer.hpp"
#include "mcap_writer.hpp"
#include "message_trace.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/output/trace.hpp"

#include <cstdlib>

namespace bin_scenes {

namespace {

// As for any node of ROS: `ROS_NAMESPACE=cell bin_scenes generate ... --formats bag`.
std::string name_space() {
  const char* set = std::getenv("ROS_NAMESPACE");
  return set ? set : "";
}

[[maybe_unused]] const bool registered = [] {
  register_bag_writer([](const std::string& path, const Scene& scene, const LoadedRequest& loaded,
                         const std::vector<RangeImage>& images) {
    write_bag(path, scene, loaded, images, bag_stamp(scene.index), {}, name_space());
  });
  register_mcap_writer([](const std::string& path, McapProfile profile, const Scene& scene, const LoadedRequest& loaded,
                          const std::vector<RangeImage>& images) {
    write_mcap(path, profile, scene, loaded, images, bag_stamp(scene.index), name_space());
  });
  register_message_trace(message_trace);
  return true;
}();

}  // namespace

}  // namespace bin_scenes
