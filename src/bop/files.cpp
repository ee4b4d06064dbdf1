/// Finds masks, images and depth of a view by the names that BOP gives them.
#include "bop/files.hpp"

#include "bin_scenes/core/error.hpp"
#include "bop/json_file.hpp"
#include "output/png_reader.hpp"
#include "output/tiff.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* picture_extensions[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".JPG", ".PNG"};

/// The path of an image of any extension; empty if there is none.
fs::path image_of(const BopView& view, const std::string& kind) {
  const fs::path folder = view.files().folder(kind);
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

BopMasks::BopMasks(const BopView& view, std::string kind)
    : view_(view), kind_(std::move(kind)), run_lengths_file_(view.files().run_lengths(kind_)) {
  const auto json = json_map_in<nlohmann::json>(run_lengths_file_);
  const std::string key = std::to_string(view.image);
  if (!json || !json->contains(key) || !json->at(key).is_object()) return;
  for (const auto& [entry, mask] : json->at(key).items()) run_lengths_[std::stoul(entry)] = mask.dump();
}

std::optional<BinaryImage> BopMasks::of(std::size_t entry) const {
  const fs::path path = view_.files().mask(kind_, static_cast<std::size_t>(view_.image), entry);
  if (fs::is_regular_file(path)) return binary(load_png(path.string()));
  const auto known = run_lengths_.find(entry);
  if (known == run_lengths_.end()) return std::nullopt;
  return from_run_lengths(known->second, place(entry));
}

std::string BopMasks::place(std::size_t entry) const {
  if (run_lengths_.empty()) return view_.files().mask(kind_, static_cast<std::size_t>(view_.image), entry).string();
  return run_lengths_file_.string() + ", image " + std::to_string(view_.image) + ", entry " + std::to_string(entry);
}

std::vector<std::string> bop_kinds(const BopView& view) {
  static const std::set<std::string> known = {"rgb", "gray", "depth", "aolp", "dolp", "mask", "mask_visib"};
  std::vector<std::string> kinds;
  for (const std::string& kind : known) {
    const bool mask = kind.rfind("mask", 0) == 0;
    if (fs::is_directory(view.files().folder(kind)) || (mask && fs::is_regular_file(view.files().run_lengths(kind))))
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
