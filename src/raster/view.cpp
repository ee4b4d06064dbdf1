#include "bin_scenes/raster/view.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "core/in_parallel.hpp"
#include "raster/drawing.hpp"
#include "raster/pixel_rays.hpp"

namespace bin_scenes {

View render(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far) {
  BIN_SCENES_ASSERT(lens.width > 0 && lens.height > 0 && lens.fx > 0.0 && lens.fy > 0.0);
  BIN_SCENES_ASSERT(is_rigid(pose) && near <= far);
  if (std::optional<View> view = drawn(scenery, lens, pose, near, far, nullptr)) return std::move(*view);
  return cast(scenery, lens, pose, near, far);
}

View cast(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far) {
  View view;
  view.lens = lens;
  view.pose = pose;
  const auto width = static_cast<std::size_t>(lens.width), height = static_cast<std::size_t>(lens.height);
  view.depth.resize(width * height);
  view.label.resize(width * height);
  view.normal.resize(width * height);
  view.line.resize(width * height);
  view.face.resize(width * height);
  const Mat3 turn = pose.orientation.toRotationMatrix(), back = turn.transpose();
  const PixelRays directions(lens);
  in_parallel(height, [&](std::size_t row) {
    std::vector<Ray> rays(width);
    std::vector<Hit> hits(width);
    for (std::size_t column = 0; column < width; ++column) {
      rays[column] = {pose.position, turn * directions.at(column, row), near, far};
    }
    scenery.first_hits(rays.data(), hits.data(), width);
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t i = row * width + column;
      const Hit& hit = hits[column];
      const Vec3 normal = back * hit.normal;
      view.depth[i] = hit.distance;
      view.label[i] = hit.label;
      view.normal[i] = {static_cast<float>(normal.x()), static_cast<float>(normal.y()), static_cast<float>(normal.z())};
      view.line[i] = hit.line;
      view.face[i] = scenery.face_of(hit);
    }
  });
  return view;
}

}  // namespace bin_scenes
