/// Computes the bounding boxes of parts in an image, for BOP files and for the block `truth` of scene.json.
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
  std::array<int, 4> xywh() const;  ///< x, y, width, height; -1 for nothing
  /// As scene_gt_info.json of BOP has it: x, y, and the last pixel less the first.
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

/// By part id, of the pixels that truly show it.
std::vector<PixelBox> visible_boxes(const RangeImage& image, std::size_t parts);
/// Of the whole silhouette, hidden or outside the image included: the projected vertices.
PixelBox projected_box(const Mesh& mesh, const Pose& model_in_camera, const Sensor& sensor);

}  // namespace bin_scenes
