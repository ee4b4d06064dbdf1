#include "bin_scenes/core/error.hpp"
#include "output/bop_image.hpp"

#include <zlib.h>

#include <cstdio>
#include <cstring>
#include <filesystem>

namespace bin_scenes {

namespace {

template <class Number>
void put(Bytes& bytes, Number value) {
  for (std::size_t i = 0; i < sizeof value; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xff));
}

nlohmann::ordered_json run_lengths_of(const std::vector<MaskBox>& masks, int width, int height) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < masks.size(); ++i)
    json[std::to_string(i)] = {{"counts", run_lengths(masks[i], width, height)}, {"size", {height, width}}};
  return json;
}

}  // namespace

std::vector<std::size_t> run_lengths(const MaskBox& mask, int width, int height) {
  const auto rows = static_cast<std::size_t>(height), pixels = rows * static_cast<std::size_t>(width);
  std::vector<std::size_t> counts;
  std::size_t begin = 0;  // of the run that is under way, in pixels from the upper left, column by column
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
  return counts;
}

Bytes gray_tiff(int width, int height, const std::vector<std::uint8_t>& samples) {
  uLongf size = compressBound(static_cast<uLong>(samples.size()));
  Bytes packed(size);
  if (compress2(packed.data(), &size, samples.data(), static_cast<uLong>(samples.size()), 1) != Z_OK)
    throw environment_error("zlib cannot pack an image", "image", "check free memory");
  packed.resize(size);
  if (packed.size() % 2 != 0) packed.push_back(0);  // what follows begins at an even byte
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t value;
  };
  constexpr std::uint16_t shorts = 3, longs = 4;
  const std::vector<Entry> entries = {{256, longs, static_cast<std::uint32_t>(width)},   // width
                                      {257, longs, static_cast<std::uint32_t>(height)},  // height
                                      {258, shorts, 8},                                  // bits a sample
                                      {259, shorts, 8},                                  // deflate
                                      {262, shorts, 1},                                  // 0 is black
                                      {273, longs, 8},                                   // the only strip begins here
                                      {277, shorts, 1},                                  // samples a pixel
                                      {278, longs, static_cast<std::uint32_t>(height)},  // rows of the strip
                                      {279, longs, static_cast<std::uint32_t>(size)}};   // bytes of the strip
  Bytes bytes = {'I', 'I', 42, 0};
  put(bytes, static_cast<std::uint32_t>(8 + packed.size()));
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  put(bytes, static_cast<std::uint16_t>(entries.size()));
  for (const Entry& entry : entries) {
    put(bytes, entry.tag);
    put(bytes, entry.type);
    put(bytes, std::uint32_t{1});
    put(bytes, entry.value);
  }
  put(bytes, std::uint32_t{0});
  return bytes;
}

void write_bop_samples(const std::string& directory, std::size_t scene, const std::vector<BopImage>& images) {
  for (std::size_t n = 0; n < images.size(); ++n) {
    const BopImage& image = images[n];
    char key[48];
    std::snprintf(key, sizeof key, "%06zu_%06zu.", scene, n);
    const std::string base = (std::filesystem::path(directory) / key).string();
    write_bytes(base + "depth.png", image.depth);
    write_bytes(base + "gray.tiff", gray_tiff(image.gray_width, image.gray_height, image.gray));
    write_text(base + "camera.json", image.camera.dump());
    write_text(base + "gt.json", image.truth.dump());
    write_text(base + "gt_info.json", image.info.dump());
    write_text(base + "mask_visib.json", run_lengths_of(image.visible, image.width, image.height).dump());
    if (!image.whole.empty())
      write_text(base + "mask.json", run_lengths_of(image.whole, image.width, image.height).dump());
  }
}

}  // namespace bin_scenes
