#include "bop/masks.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <numeric>

namespace bin_scenes {

MaskBox visible_mask(const RangeImage& image, int id, const PixelBox& box) {
  MaskBox mask;
  if (box.empty()) return mask;
  BIN_SCENES_ASSERT(box.left >= 0 && box.top >= 0 && box.right < image.sensor.width &&
                    box.bottom < image.sensor.height);
  mask.left = box.left, mask.top = box.top;
  mask.width = box.right - box.left + 1, mask.height = box.bottom - box.top + 1;
  for (int y = box.top; y <= box.bottom; ++y) {
    const std::uint16_t* label = &image.seen_label()[static_cast<std::size_t>(y) * image.sensor.width + box.left];
    for (int x = 0; x < mask.width; ++x) mask.inside.push_back(label[x] == id + 1);
  }
  return mask;
}

MaskBox whole_mask(const Silhouette& s) {
  MaskBox mask{s.left, s.top, s.width, s.height, {}};
  BIN_SCENES_ASSERT(s.bits.size() == s.words_per_row() * static_cast<std::size_t>(s.height));
  mask.inside.reserve(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height));
  for (int y = 0; y < s.height; ++y) {
    const std::uint64_t* row = &s.bits[static_cast<std::size_t>(y) * s.words_per_row()];
    for (int x = 0; x < s.width; ++x) mask.inside.push_back(row[x / 64] >> (x % 64) & 1u);
  }
  return mask;
}

std::size_t BinaryImage::count() const {
  return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
}

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

/// The compressed form of pycocotools (rleFrString of maskApi.c): groups of 5 bits, lowest first, from the third run on
/// as differences to the run before the last.
std::vector<long> decompressed(const std::string& text, const std::string& where) {
  std::vector<long> counts;
  for (std::size_t at = 0; at < text.size();) {
    long value = 0;
    int shift = 0;
    bool more = true;
    while (more) {
      if (at == text.size() || shift > 55) throw input_error("run lengths are cut off", where, "write the file anew");
      const int c = text[at++] - 48;
      value |= static_cast<long>(c & 0x1f) << shift;
      more = (c & 0x20) != 0;
      shift += 5;
      if (!more && (c & 0x10) != 0) value -= 1L << shift;
    }
    if (counts.size() > 2) value += counts[counts.size() - 2];
    counts.push_back(value);
  }
  return counts;
}

}  // namespace

BinaryImage from_run_lengths(const std::string& text, const std::string& where) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  BinaryImage mask;
  try {
    mask.height = json.at("size").at(0);
    mask.width = json.at("size").at(1);
    const auto rows = static_cast<std::size_t>(mask.height), pixels = rows * static_cast<std::size_t>(mask.width);
    const nlohmann::json& stored = json.at("counts");
    const std::vector<long> counts =
        stored.is_string() ? decompressed(stored.get<std::string>(), where) : stored.get<std::vector<long>>();
    mask.inside.assign(pixels, 0);
    std::size_t at = 0;
    std::uint8_t value = 0;
    for (const long count : counts) {
      if (count < 0 || static_cast<std::size_t>(count) > pixels - at)
        throw input_error("run lengths are longer than the image", where, "write the file anew");
      for (const std::size_t end = at + static_cast<std::size_t>(count); at < end; ++at)
        mask.inside[at % rows * static_cast<std::size_t>(mask.width) + at / rows] = value;
      value = 1 - value;
    }
  } catch (const nlohmann::json::exception& error) {
    throw input_error(std::string("is no mask of run lengths: ") + error.what(), where, "write the file anew");
  }
  return mask;
}

}  // namespace bin_scenes
