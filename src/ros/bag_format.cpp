/// Makes `--formats bag` known to the program that this file is linked into (output/scene_writer.hpp).
#include "bag_writer.hpp"

#include "bin_scenes/output/scene_writer.hpp"

#include <cstdlib>

namespace bin_scenes {

namespace {

[[maybe_unused]] const bool registered = [] {
  register_bag_writer([](const std::string& path, const Scene& scene, const Request& request,
                         const std::vector<RangeImage>& images, const std::vector<PartModelPtr>& parts,
                         const PartModelPtr& bin_model) {
    // As for any node of ROS: `ROS_NAMESPACE=cell bin_scenes generate ... --formats bag`.
    const char* name_space = std::getenv("ROS_NAMESPACE");
    write_bag(path, scene, request, images, parts, bin_model, bag_stamp(scene.index), {}, name_space ? name_space : "");
  });
  return true;
}();

}  // namespace

}  // namespace bin_scenes
