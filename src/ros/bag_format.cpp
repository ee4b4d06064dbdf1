/// Makes `--formats bag,mcap` (output/scene_writer.hpp) and `--trace FILE.bag` (output/trace.hpp) known to the program
/// that this file is linked into.
#include "bag_trace.hpp"
#include "bag_writer.hpp"
#include "mcap_writer.hpp"

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
  register_bag_trace([](const std::string& path, const Request& request) -> std::unique_ptr<Trace> {
    return std::make_unique<BagTrace>(path, request);
  });
  return true;
}();

}  // namespace

}  // namespace bin_scenes
