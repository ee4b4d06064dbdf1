#include "output/boxes.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/sensor/resolve.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

void PixelBox::extend(int x, int y) {
  left = std::min(left, x), top = std::min(top, y), right = std::max(right, x), bottom = std::max(bottom, y);
}

std::array<int, 4> PixelBox::xywh() const {
  if (empty()) return {-1, -1, -1, -1};
  return {left, top, right - left + 1, bottom - top + 1};
}

std::vector<PixelBox> visible_boxes(const RangeImage& image, std::size_t parts) {
  std::vector<PixelBox> boxes(parts);
  BIN_SCENES_ASSERT(image.seen_label().size() == static_cast<std::size_t>(image.sensor.width) * image.sensor.height);
  const std::uint16_t* label = image.seen_label().data();
  for (int y = 0; y < image.sensor.height; ++y) {
    for (int x = 0; x < image.sensor.width; ++x, ++label) {
      if (*label > 0 && *label <= parts) boxes[*label - 1u].extend(x, y);
    }
  }
  return boxes;
}

PixelBox projected_box(const Mesh& mesh, const Pose& model_in_camera, const Sensor& sensor) {
  const Lens lens = lens_of(sensor);
  const Mat3 turn = model_in_camera.orientation.toRotationMatrix();
  PixelBox box;
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 p = turn * vertex + model_in_camera.position;
    const auto pixel = p.z() > 1e-6 ? lens.project(p) : std::nullopt;
    if (!pixel) return {};  // behind the camera: no box of the silhouette exists
    const Eigen::Array2d at = (pixel->array() + 0.5).floor().max(-1e9).min(1e9);
    box.extend(static_cast<int>(at.x()), static_cast<int>(at.y()));
  }
  return box;
}

}  // namespace bin_scenes
