/// Computes the bounding boxes of parts in an image, for BOP files and for the block `truth` of scene.json. Boxes are
/// in pixels of the image as taken.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <array>
#include <vector>

namespace bin_scenes {

/// Inclusive pixel bounds, which may be outside the image.
struct PixelBox {
  int left = 1 << 30, top = 1 << 30, right = -(1 << 30), bottom = -(1 << 30);
  void extend(int x, int y);
  bool empty() const { return right < left; }
  std::array<int, 4> xywh() const;  ///< x, y, width, height; all -1 if the box is empty
  /// Returns the box as BOP's scene_gt_info.json defines it: x, y, and the last pixel minus the first one.
  std::array<int, 4> first_to_last() const { return {left, top, right - left, bottom - top}; }
};

/// The number of pixels of one part in an image, and the box around them.
struct Extent : PixelBox {
  std::size_t count = 0;
  void add(int x, int y) {
    ++count;
    extend(x, y);
  }
};

/// Returns, by part id, the boxes of the pixels that truly show the part.
std::vector<PixelBox> visible_boxes(const RangeImage& image, std::size_t parts);
/// Returns the box of the whole silhouette, including hidden parts and those outside of the image. It is the box of the
/// projected vertices.
PixelBox projected_box(const Mesh& mesh, const Pose& model_in_camera, const Sensor& sensor);

}  // namespace bin_scenes
