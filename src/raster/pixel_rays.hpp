/// Directions of the pixels of a camera: Lens::ray() at pixel centres, where everything that is constant for a row or a
/// column is computed once. Without distortion and skew, a direction costs two table lookups.
#pragma once

#include "bin_scenes/raster/lens.hpp"

#include <cstddef>
#include <vector>

namespace bin_scenes {

class PixelRays {
 public:
  explicit PixelRays(const Lens& lens) : lens_(lens), plain_(!lens.distorts() && lens.skew == 0.0) {
    for (int x = 0; plain_ && x < lens.width; ++x) x_.push_back((x - lens.cx) / lens.fx);
    for (int y = 0; plain_ && y < lens.height; ++y) y_.push_back((y - lens.cy) / lens.fy);
  }
  Vec3 at(std::size_t column, std::size_t row) const {
    if (plain_) return {x_[column], y_[row], 1.0};
    return lens_.ray(static_cast<double>(column), static_cast<double>(row));
  }
  /// The x of each ray (z = 1) in a row, and the y of all rays in the row. Valid only without distortion and skew.
  const double* x() const { return x_.data(); }
  double y(int row) const { return y_[static_cast<std::size_t>(row)]; }

 private:
  Lens lens_;
  bool plain_;
  std::vector<double> x_, y_;
};

}  // namespace bin_scenes
