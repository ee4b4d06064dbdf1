#include "bag_hook.hpp"

#include "bag_writer.hpp"

#include "bin_scenes/output/scene_writer.hpp"

namespace bin_scenes {

void install_bag_writer() {
  register_bag_writer([](const std::string& path, const Scene& scene, const Request& request,
                         const std::vector<RangeImage>& images, const std::vector<PartModelPtr>& parts,
                         const PartModelPtr& bin_model) {
    write_bag(path, scene, request, images, parts, bin_model, bag_stamp(scene.index));
  });
}

}  // namespace bin_scenes
