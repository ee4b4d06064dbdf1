/// Renders the models at their stated poses by the library's own rays, and compares masks and depth with the result.
#include "audit/labels.hpp"

#include "audit/label_compare.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bop/visibility.hpp"
#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr std::size_t least_pixels = 25;  ///< that state a depth
constexpr std::size_t least_mask = 50;    ///< pixels of a mask or silhouette whose overlap means something

std::size_t pixel_of(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

BinaryImage image_of(const MaskBox& box, int width, int height) {
  BinaryImage image{width, height, std::vector<std::uint8_t>(pixel_of(0, height, width), 0)};
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      image.inside[pixel_of(box.left + x, box.top + y, width)] = box.inside[pixel_of(x, y, box.width)];
  return image;
}

BinaryImage image_of(const Silhouette& silhouette, int width, int height) {
  BinaryImage image{width, height, std::vector<std::uint8_t>(pixel_of(0, height, width), 0)};
  for (int y = silhouette.top; y < silhouette.top + silhouette.height; ++y)
    for (int x = silhouette.left; x < silhouette.left + silhouette.width; ++x)
      image.inside[pixel_of(x, y, width)] = silhouette.at(x, y);
  return image;
}

Eigen::Vector2d centre_of(const Silhouette& silhouette) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int y = silhouette.top; y < silhouette.top + silhouette.height; ++y)
    for (int x = silhouette.left; x < silhouette.left + silhouette.width; ++x)
      if (silhouette.at(x, y)) sum += Eigen::Vector2d(x, y);
  return sum / std::max(1.0, static_cast<double>(silhouette.count));
}

std::string entry_text(std::size_t entry) {
  return "entry " + std::to_string(entry);
}

}  // namespace

/// The models at their stated poses, as the corrected camera sees them.
struct LabelAuditor::Rendered {
  Sensor sensor;
  RangeImage image;
  BinaryImage visible(std::size_t entry) const {
    BinaryImage mask{image.width, image.height, {}};
    const auto label = static_cast<std::uint16_t>(entry + 1);
    for (const std::uint16_t value : image.seen_label()) mask.inside.push_back(value == label);
    return mask;
  }
  BinaryImage silhouette(std::size_t entry) const {
    return image_of(image.silhouettes.at(entry), image.width, image.height);
  }
};

/// What the data set holds of an image.
struct LabelAuditor::Stored {
  std::vector<std::optional<BinaryImage>> whole, visible;  ///< by entry
  std::optional<BopDepth> depth;
  std::vector<float> distance;  ///< m, of `depth`; empty without
};

LabelAuditor::LabelAuditor(const BopSet& set, const std::map<int, PartModelPtr>& models, SensorRig& rig)
    : models_(models), rig_(rig) {
  for (const BopView& view : set.views)
    for (const std::string& kind : bop_kinds(view)) kinds_[view.suffix].insert(kind);
}

LabelledImage LabelAuditor::missing_files(const BopView& view) const {
  LabelledImage image;
  image.parts.resize(view.parts.size());
  const auto known = kinds_.find(view.suffix);
  if (known == kinds_.end()) return image;
  for (const std::string& kind : known->second)
    if (kind.rfind("mask", 0) != 0 && !has_image(view, kind))
      image.faults.push_back("its " + kind + " image is missing");
  const auto stated =
      std::count_if(view.parts.begin(), view.parts.end(), [](const BopPart& p) { return p.px_visible; });
  if (stated > 0 && static_cast<std::size_t>(stated) < view.parts.size())
    image.faults.push_back("scene_gt_info has " + std::to_string(stated) + " entries for " +
                           std::to_string(view.parts.size()) + " parts");
  return image;
}

namespace {

/// Masks of one kind; those that are missing are named where the data set has masks of this kind.
std::vector<std::optional<BinaryImage>> masks_of(const BopView& view, const std::string& kind, bool wanted,
                                                 LabelledImage& image) {
  std::vector<std::optional<BinaryImage>> masks(view.parts.size());
  if (!wanted) return masks;
  const BopMasks files(view, kind);
  in_parallel(masks.size(), [&](std::size_t i) { masks[i] = files.of(i); });
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (!masks[i]) {
      image.parts[i].faults.push_back("its " + kind + " is missing: " + files.place(i));
      continue;
    }
    if (image.width == 0) image.width = masks[i]->width, image.height = masks[i]->height;
    if (masks[i]->width != image.width || masks[i]->height != image.height)
      throw input_error("is " + std::to_string(masks[i]->width) + " x " + std::to_string(masks[i]->height) +
                            ", other masks are " + std::to_string(image.width) + " x " + std::to_string(image.height),
                        files.place(i), "masks have the size of their image");
  }
  return masks;
}

}  // namespace

LabelAuditor::Rendered LabelAuditor::render(const BopView& view, const Surroundings& around, const CameraError& error,
                                            int width, int height) const {
  Rendered own;
  Sensor sensor;
  sensor.width = width, sensor.height = height;
  const std::array<double, 9> k = error.corrected(view.k);
  sensor.k.assign(k.begin(), k.end());
  sensor.distortion[0] = error.radial;
  sensor.pose = around.shift * view.camera;
  sensor.near = 0.01, sensor.far = 100.0;
  Scene scene;
  LoadedRequest loaded;
  loaded.request.bin = around.bin;
  std::map<int, std::size_t> lines;
  for (std::size_t i = 0; i < view.parts.size(); ++i) {
    const BopPart& stated = view.parts[i];
    const auto [line, added] = lines.emplace(stated.object, loaded.parts.size());
    if (added) {
      loaded.parts.push_back(models_.at(stated.object));
      loaded.request.parts.emplace_back();
    }
    ScenePart part;
    part.id = static_cast<int>(i);
    part.line = line->second;
    part.pose = around.shift * stated.in_world;
    part.state = PartState::resting;
    scene.parts.push_back(part);
  }
  for (const Surroundings::Other& other : around.others) {
    ScenePart part;
    part.id = static_cast<int>(scene.parts.size());
    part.line = loaded.parts.size();
    part.pose = around.shift * other.in_world;
    part.state = PartState::fixed;
    part.distractor = true;
    scene.parts.push_back(part);
    loaded.parts.push_back(other.model);
    loaded.request.parts.emplace_back();
  }
  scene.sensors = {resolved(sensor, around.bin, nullptr)};
  own.sensor = scene.sensors.front();
  own.image = rig_.render(scene, loaded).front();
  return own;
}

namespace {

/// Where another part, the bin, or what the depth image shows in front of it hides a part.
BinaryImage hidden_of(const BinaryImage& silhouette, const RangeImage& own, std::size_t entry,
                      const std::optional<BopDepth>& depth) {
  constexpr float in_front = 0.005f;  // m
  BinaryImage hidden{silhouette.width, silhouette.height, std::vector<std::uint8_t>(silhouette.inside.size(), 0)};
  for (std::size_t i = 0; i < hidden.inside.size(); ++i) {
    if (!silhouette.inside[i]) continue;
    const bool by_model = own.seen_label()[i] != entry + 1;
    const bool by_depth = depth && depth->depth[i] > 0.0f && depth->depth[i] < own.seen_depth()[i] - in_front;
    hidden.inside[i] = by_model || by_depth;
  }
  return hidden;
}

/// Median of measured less model's depth over the inner pixels of a part, and where they are.
void measure_depth(const RangeImage& own, std::size_t entry, const BopDepth& depth,
                   const std::optional<BinaryImage>& visible, LabelFigures& figures) {
  const auto label = static_cast<std::uint16_t>(entry + 1);
  const std::vector<std::uint16_t>& labels = own.seen_label();
  const Lens lens = lens_of(own.sensor);
  std::vector<double> errors;
  double sum = 0.0, oblique = 0.0;
  const Silhouette& box = own.silhouettes.at(entry);
  for (int y = std::max(1, box.top); y < std::min(box.top + box.height, own.height - 1); ++y) {
    for (int x = std::max(1, box.left); x < std::min(box.left + box.width, own.width - 1); ++x) {
      const std::size_t i = pixel_of(x, y, own.width), row = static_cast<std::size_t>(own.width);
      const bool inner = labels[i] == label && labels[i - 1] == label && labels[i + 1] == label &&
                         labels[i - row] == label && labels[i + row] == label;
      if (!inner || depth.depth[i] <= 0.0f || (visible && !visible->inside[i])) continue;
      const auto model = static_cast<double>(own.seen_depth()[i]);
      errors.push_back(mm_per_metre * (static_cast<double>(depth.depth[i]) - model));
      sum += model;
      oblique += lens.ray(x, y).norm() - 1.0;
    }
  }
  if (errors.size() < least_pixels) return;
  const auto count = static_cast<double>(errors.size());
  const double median = median_of(errors);
  std::vector<double> apart;
  for (const double error : errors) apart.push_back(std::abs(error - median));
  // Of a median 1.25 times that of a mean; noise is common to about nine neighbouring pixels.
  figures.depth_spread = 1.4826 * median_of(apart);
  figures.depth_error = 1.25 * figures.depth_spread / std::sqrt(count / 9.0);
  figures.depth = median;
  figures.model_depth = sum / count;
  figures.obliqueness = oblique / count;
}

}  // namespace

/// Against what rays show, or, where that fits better, what bop_toolkit's rule makes of the depth image, at the
/// tolerances that data sets use.
void LabelAuditor::compare_visible(const BopView& view, std::size_t entry, const Rendered& own, const Stored& stored,
                                   LabelFigures& figures) const {
  constexpr double agrees = 0.95, same_fraction = 0.01;
  const BopPart& part = view.parts[entry];
  const std::optional<BinaryImage>& seen = stored.visible[entry];
  const BinaryImage visible = own.visible(entry);
  const auto compare = [&](const BinaryImage& rule, std::size_t count, std::size_t all) {
    if (seen && std::max(count, seen->count()) >= least_mask)
      figures.iou_visible = std::max(figures.iou_visible.value_or(0.0), tolerant_iou(rule, *seen));
    if (!part.visible || all == 0) return;
    const double off = *part.visible - static_cast<double>(count) / static_cast<double>(all);
    if (!figures.visible || std::abs(off) < std::abs(*figures.visible)) figures.visible = off;
  };
  compare(visible, visible.count(), own.image.silhouettes.at(entry).count);
  for (const double tolerance : {0.0015, 0.005, 0.015}) {
    const bool good =
        figures.iou_visible.value_or(1.0) >= agrees && std::abs(figures.visible.value_or(0.0)) < same_fraction;
    if (good || stored.distance.empty()) return;
    const auto rule = bop_visibility(models_.at(part.object)->mesh(), part.in_camera, lens_of(own.sensor),
                                     stored.distance, tolerance);
    if (rule) compare(image_of(rule->visible_mask, visible.width, visible.height), rule->visible, rule->all);
  }
}

LabelFigures LabelAuditor::figures(const BopView& view, std::size_t entry, const Rendered& own,
                                   const Stored& stored) const {
  LabelFigures figures;
  const BinaryImage silhouette = own.silhouette(entry);
  const Silhouette& pixels = own.image.silhouettes.at(entry);
  figures.at = centre_of(pixels);
  compare_visible(view, entry, own, stored, figures);
  const std::optional<BinaryImage>&whole = stored.whole[entry], &seen = stored.visible[entry];
  if (whole) {
    if (std::max(pixels.count, whole->count()) >= least_mask) figures.iou = tolerant_iou(silhouette, *whole);
    figures.shift = mask_shift(silhouette, *whole, {});
  } else if (seen) {
    figures.shift = mask_shift(silhouette, *seen, hidden_of(silhouette, own.image, entry, stored.depth));
  }
  const std::optional<long> stated = view.parts[entry].px_visible;
  if (seen && stated) {
    const double expected = static_cast<double>(*stated), there = static_cast<double>(seen->count());
    figures.counted = 100.0 * std::abs(there - expected) / std::max({1.0, expected, there});
  }
  if (stored.depth) measure_depth(own.image, entry, *stored.depth, seen, figures);
  return figures;
}

/// Masks that fit another part of the image, and silhouettes that fit with another model.
void LabelAuditor::name_exchanged(const BopView& view, const Rendered& own, const Stored& stored,
                                  LabelledImage& image) const {
  constexpr double misfit = 0.6, fits = 0.8;
  const int width = own.image.width, height = own.image.height;
  const std::vector<float> nothing(pixel_of(0, height, width), 0.0f);
  for (std::size_t i = 0; i < view.parts.size(); ++i) {
    LabelFigures& part = image.parts[i];
    const bool by_whole = part.iou && *part.iou < misfit, by_seen = part.iou_visible && *part.iou_visible < misfit;
    if (!by_whole && !by_seen) continue;
    const BinaryImage& mask = by_whole ? *stored.whole[i] : *stored.visible[i];
    const std::string kind = by_whole ? "mask" : "mask_visib";
    if (mask.count() == 0) {
      part.faults.push_back("its " + kind + " is empty");
      continue;
    }
    double best = fits;
    std::string text;
    for (std::size_t j = 0; j < view.parts.size(); ++j) {
      if (j == i) continue;
      const double fit = tolerant_iou(by_whole ? own.silhouette(j) : own.visible(j), mask);
      if (fit > best) best = fit, text = "its " + kind + " shows " + entry_text(j);
    }
    for (const auto& [object, model] : models_) {
      if (object == view.parts[i].object || !by_whole) continue;
      const auto other = bop_visibility(model->mesh(), view.parts[i].in_camera, lens_of(own.sensor), nothing, 1.0);
      const double fit = other ? tolerant_iou(image_of(other->whole_mask, width, height), mask) : 0.0;
      if (fit > best)
        best = fit,
        text = "its mask fits object " + std::to_string(object) + ", obj_id is " + std::to_string(view.parts[i].object);
    }
    if (!text.empty()) part.faults.push_back(text);
  }
}

LabelledImage LabelAuditor::compare(const BopView& view, const Surroundings& around, const CameraError& error) const {
  LabelledImage image = missing_files(view);
  const auto known = kinds_.find(view.suffix);
  const auto has = [&](const char* kind) { return known != kinds_.end() && known->second.count(kind) > 0; };
  Stored stored;
  stored.whole = masks_of(view, "mask", has("mask"), image);
  stored.visible = masks_of(view, "mask_visib", has("mask_visib"), image);
  stored.depth = depth_of(view);
  if (stored.depth && image.width == 0) image.width = stored.depth->width, image.height = stored.depth->height;
  if (image.width == 0 || view.parts.empty()) return image;
  if (stored.depth && (stored.depth->width != image.width || stored.depth->height != image.height)) {
    image.faults.push_back("its depth image has another size than its masks");
    stored.depth.reset();
  }
  const Rendered own = render(view, around, error, image.width, image.height);
  if (stored.depth) stored.distance = distances(stored.depth->depth, lens_of(own.sensor));
  std::vector<LabelFigures> all(view.parts.size());
  in_parallel(all.size(), [&](std::size_t i) { all[i] = figures(view, i, own, stored); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].faults = std::move(image.parts[i].faults);
    image.parts[i] = std::move(all[i]);
  }
  name_exchanged(view, own, stored, image);
  return image;
}

}  // namespace bin_scenes
