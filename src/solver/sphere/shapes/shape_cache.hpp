/// Keeps the shapes of the parts that a solver has used, so that many worlds share one shape. A shape is made on first
/// use and stays for the life of the cache. The cache on the disk, which survives the program, is
/// bin_scenes/core/cache.hpp.
#pragma once

#include "bin_scenes/core/profile.hpp"
#include "bin_scenes/scene/request.hpp"
#include "solver/sphere/shapes/sample_clusters.hpp"
#include "solver/sphere/shapes/shape.hpp"

#include <functional>
#include <map>
#include <memory>
#include <utility>

namespace bin_scenes::sphere {

class ShapeCache {
 public:
  /// @param change  is applied to each shape after it is made, and its samples are laid out again; none: no changes
  explicit ShapeCache(const SphereSettings& settings, std::function<void(Shape&)> change = {})
      : settings_(settings), change_(std::move(change)) {}

  /// Returns the shape of a part, which is made on first use (stage "shape" of the profile). Its address never changes.
  const Shape& of(const PartModelPtr& part, Profile& profile) {
    Entry& entry = entries_[part.get()];
    if (!entry.shape) {
      StageTimer timer(profile, "shape");
      entry.part = part;  // the address is the key; this keeps it valid
      entry.shape = std::make_unique<Shape>(make_shape(*part, settings_.coarse_samples, settings_.fine_samples,
                                                       settings_.field_cell, settings_.field_nodes));
      if (change_) {
        change_(*entry.shape);
        for (Samples* samples : {&entry.shape->coarse, &entry.shape->fine}) lay_out(*samples);
      }
    }
    return *entry.shape;
  }

 private:
  struct Entry {
    PartModelPtr part;
    std::unique_ptr<Shape> shape;
  };
  SphereSettings settings_;
  std::function<void(Shape&)> change_;
  std::map<const PartModel*, Entry> entries_;
};

}  // namespace bin_scenes::sphere
