#include "bop/samples.hpp"

#include "bin_scenes/output/image_channel.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/formatted.hpp"
#include "output/tiff.hpp"

#include <filesystem>

namespace bin_scenes {

namespace {

/// "DIR/000017_000000.": what the names of an image's files begin with.
std::string sample_base(const std::string& directory, std::size_t scene, std::size_t image) {
  return (std::filesystem::path(directory) / formatted("%06zu_%06zu.", scene, image)).string();
}

}  // namespace

void write_grasp_samples(const std::string& directory, const Scene& scene, std::size_t number,
                         const SceneGrasps& grasps, const Request& request) {
  const std::string text = grasps_json(grasps, scene, request);
  for (std::size_t n = 0; n < scene.sensors.size(); ++n)
    write_text(sample_base(directory, number, n) + "grasps.json", text);
}

void write_bop_samples(const std::string& directory, std::size_t scene, const std::vector<BopImage>& images) {
  for (std::size_t n = 0; n < images.size(); ++n) {
    const BopImage& image = images[n];
    const std::string base = sample_base(directory, scene, n);
    write_bytes(base + "depth.png", png16(image.width, image.height, image.counts));
    write_bytes(base + "gray.tiff", tiff8(image.width, image.height, 1, image.gray));
    if (image.seen->picture.channels == 3)
      write_bytes(base + "rgb.png", png8(image.width, image.height, 3, in_bytes(image.seen->picture)));
    if (image.seen->picture.bits == 16)  // which readers of BOP's own files cut to their lower 8
      write_bytes(base + "image.png", png_of(image.width, image.height, image.seen->picture));
    for (const ImageChannel& channel : image_channels())
      if (channel.in_shards)
        write_bytes(base + channel.name + ".png",
                    png_of(channel.width(*image.seen), channel.height(*image.seen), channel.counts(*image.seen)));
    write_text(base + "camera.json", image.camera.dump());
    write_text(base + "gt.json", image.truth.dump());
    write_text(base + "gt_info.json", image.info.dump());
    write_text(base + "mask_visib.json", run_lengths_of(image.visible, image.width, image.height).dump());
    if (image.whole_known())
      write_text(base + "mask.json", run_lengths_of(image.whole, image.width, image.height).dump());
  }
}

}  // namespace bin_scenes
