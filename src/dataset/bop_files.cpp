/// Finds masks, images and depth of a view by the names that BOP gives them, and decodes run lengths.
#include "dataset/bop_files.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/read_file.hpp"
#include "output/bop_image.hpp"
#include "output/png_reader.hpp"
#include "output/tiff.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

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

constexpr const char* picture_extensions[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".JPG", ".PNG"};

/// The path of an image of any extension; empty if there is none.
fs::path image_of(const BopView& view, const std::string& kind) {
  const fs::path folder = view.scene / (kind + view.suffix);
  for (const char* extension : picture_extensions) {
    const fs::path path = folder / (six_digits(static_cast<std::size_t>(view.image)) + extension);
    if (fs::is_regular_file(path)) return path;
  }
  return {};
}

BinaryImage binary(const LoadedImage& image) {
  BinaryImage mask{image.width, image.height, {}};
  const auto channels = static_cast<std::size_t>(image.channels);
  mask.inside.reserve(image.samples.size() / channels);
  for (std::size_t i = 0; i < image.samples.size(); i += channels) mask.inside.push_back(image.samples[i] != 0);
  return mask;
}

}  // namespace

std::size_t BinaryImage::count() const {
  return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
}

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

fs::path run_lengths_file(const fs::path& scene, const std::string& kind, const std::string& suffix) {
  return scene / ("scene_" + kind + suffix + ".json");
}

BopMasks::BopMasks(const BopView& view, std::string kind)
    : view_(view), kind_(std::move(kind)), run_lengths_file_(run_lengths_file(view.scene, kind_, view.suffix)) {
  std::error_code ignored;
  if (!fs::is_regular_file(run_lengths_file_, ignored)) return;
  const nlohmann::json json = nlohmann::json::parse(read_file(run_lengths_file_.string()), nullptr, false);
  const std::string key = std::to_string(view.image);
  if (!json.is_object() || !json.contains(key) || !json[key].is_object()) return;
  for (const auto& [entry, mask] : json[key].items()) run_lengths_[std::stoul(entry)] = mask.dump();
}

std::optional<BinaryImage> BopMasks::of(std::size_t entry) const {
  const fs::path path = mask_of(view_, kind_, entry);
  if (fs::is_regular_file(path)) return binary(load_png(path.string()));
  const auto known = run_lengths_.find(entry);
  if (known == run_lengths_.end()) return std::nullopt;
  return from_run_lengths(known->second, place(entry));
}

std::string BopMasks::place(std::size_t entry) const {
  if (run_lengths_.empty()) return mask_of(view_, kind_, entry).string();
  return run_lengths_file_.string() + ", image " + std::to_string(view_.image) + ", entry " + std::to_string(entry);
}

std::vector<std::string> bop_kinds(const BopView& view) {
  static const std::set<std::string> known = {"rgb", "gray", "depth", "aolp", "dolp", "mask", "mask_visib"};
  std::vector<std::string> kinds;
  for (const std::string& kind : known) {
    const bool mask = kind.rfind("mask", 0) == 0;
    if (fs::is_directory(view.scene / (kind + view.suffix)) ||
        (mask && fs::is_regular_file(run_lengths_file(view.scene, kind, view.suffix))))
      kinds.push_back(kind);
  }
  return kinds;
}

bool has_image(const BopView& view, const std::string& kind) {
  return !image_of(view, kind).empty();
}

std::optional<BopDepth> depth_of(const BopView& view) {
  const fs::path path = image_of(view, "depth");
  if (path.empty()) return std::nullopt;
  try {
    const bool png = path.extension() == ".png" || path.extension() == ".PNG";
    const LoadedImage image = png ? load_png(path.string()) : load_tiff(path.string());
    if (image.channels != 1) return std::nullopt;
    BopDepth depth{image.width, image.height, {}};
    depth.depth.reserve(image.samples.size());
    for (const std::uint16_t count : image.samples) depth.depth.push_back(static_cast<float>(count * view.depth_scale));
    return depth;
  } catch (const Error&) {
    return std::nullopt;  // a kind of TIFF that is not read here
  }
}

}  // namespace bin_scenes
