#include "bin_scenes/output/image_channel.hpp"

#include "bin_scenes/core/error.hpp"
#include "output/png.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

Picture words(std::vector<std::uint16_t> counts) {
  return {1, 16, std::move(counts)};
}

Picture bytes(const std::vector<std::uint8_t>& counts, int channels = 1) {
  return {channels, 8, {counts.begin(), counts.end()}};
}

std::vector<ImageChannel>& known_channels() {
  static std::vector<ImageChannel> channels = {
      {"depth", [](const RangeImage& i) { return words(counted_depth(i.depth, i.sensor.depth_scale)); }},
      {"truth_depth", [](const RangeImage& i) { return words(counted_depth(i.seen_depth(), i.sensor.depth_scale)); }, 1,
       true},
      {"truth_normal", [](const RangeImage& i) { return bytes(counted_normals(i.seen_normal()), 3); }, 3, true, true},
      {"labels", [](const RangeImage& i) { return words(i.label); }},
      {"truth_labels", [](const RangeImage& i) { return words(i.seen_label()); }, 1, true, true},
      {"snr", [](const RangeImage& i) { return words(counted_snr(i.snr)); }, 1, false, true},
      {"validity", [](const RangeImage& i) { return bytes(i.validity); }},
      {"image", [](const RangeImage& i) { return i.picture; }, 0},
  };
  return channels;
}

}  // namespace

const std::vector<ImageChannel>& image_channels() {
  return known_channels();
}

const ImageChannel* find_image_channel(const std::string& name) {
  const auto found = std::find_if(known_channels().begin(), known_channels().end(),
                                  [&](const ImageChannel& channel) { return channel.name == name; });
  return found == known_channels().end() ? nullptr : &*found;
}

void register_image_channel(ImageChannel channel) {
  if (find_image_channel(channel.name))
    throw input_error("a channel of this name is known", channel.name, "name it otherwise");
  known_channels().push_back(std::move(channel));
}

}  // namespace bin_scenes
