#include "bin_scenes/output/scene_writer.hpp"
#include "output/bop_image.hpp"
#include "output/tiff.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <cstdio>
#include <filesystem>
#include <numeric>

namespace bin_scenes {

nlohmann::ordered_json run_lengths_of(const std::vector<MaskBox>& masks, int width, int height) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < masks.size(); ++i)
    json[std::to_string(i)] = {{"counts", run_lengths(masks[i], width, height)}, {"size", {height, width}}};
  return json;
}

std::vector<std::size_t> run_lengths(const MaskBox& mask, int width, int height) {
  const auto rows = static_cast<std::size_t>(height), pixels = rows * static_cast<std::size_t>(width);
  std::vector<std::size_t> counts;
  std::size_t begin = 0;  // of the current run, in pixels from the upper left, column by column
  bool value = false;
  const auto turn = [&](std::size_t at) {
    counts.push_back(at - begin);
    begin = at;
    value = !value;
  };
  for (int x = 0; x < mask.width; ++x) {
    const std::size_t column = static_cast<std::size_t>(mask.left + x) * rows;
    const std::size_t top = column + static_cast<std::size_t>(mask.top);
    if (value && mask.height < height)
      turn(top - rows + static_cast<std::size_t>(mask.height));  // beside the box: zeros
    for (int y = 0; y < mask.height; ++y) {
      const bool inside = mask.inside[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                                      static_cast<std::size_t>(x)] != 0;
      if (inside != value) turn(top + static_cast<std::size_t>(y));
    }
  }
  if (value)
    turn(static_cast<std::size_t>(mask.left + mask.width - 1) * rows +
         static_cast<std::size_t>(mask.top + mask.height));
  if (begin < pixels || counts.empty()) counts.push_back(pixels - begin);
  BIN_SCENES_ASSERT(std::accumulate(counts.begin(), counts.end(), std::size_t{0}) == pixels);
  return counts;
}

namespace {

/// "DIR/000017_000000.": what the names of an image's files begin with.
std::string sample_base(const std::string& directory, std::size_t scene, std::size_t image) {
  char key[48];
  std::snprintf(key, sizeof key, "%06zu_%06zu.", scene, image);
  return (std::filesystem::path(directory) / key).string();
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
    write_bytes(base + "snr.png", png16(image.width, image.height, counted_snr(image.seen->snr)));
    write_bytes(base + "truth_labels.png", png16(image.width, image.height, image.seen->seen_label()));
    write_bytes(base + "truth_normal.png",
                png8(image.width, image.height, 3, counted_normals(image.seen->seen_normal())));
    write_text(base + "camera.json", image.camera.dump());
    write_text(base + "gt.json", image.truth.dump());
    write_text(base + "gt_info.json", image.info.dump());
    write_text(base + "mask_visib.json", run_lengths_of(image.visible, image.width, image.height).dump());
    if (image.whole.size() == image.ids.size())
      write_text(base + "mask.json", run_lengths_of(image.whole, image.width, image.height).dump());
  }
}

}  // namespace bin_scenes
