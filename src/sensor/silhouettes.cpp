#include "bin_scenes/sensor/silhouettes.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// Inclusive bounds in pixels.
struct Rectangle {
  int left, top, right, bottom;
  bool empty() const { return right < left || bottom < top; }
};

Rectangle whole(const Lens& lens) {
  return {0, 0, lens.width - 1, lens.height - 1};
}

/// Bounds of all pixels a mesh can cover; from its corners in the plane z = 1, where straight lines stay straight.
Rectangle bounds_of(const Mesh& mesh, const Pose& mesh_in_camera, const Lens& lens) {
  Eigen::Array2d lower = Eigen::Array2d::Constant(1e300), upper = -lower;
  const Mat3 turn = mesh_in_camera.orientation.toRotationMatrix();
  bool behind = false, before = false;
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 p = turn * vertex + mesh_in_camera.position;
    if (!(p.z() > 1e-9)) {
      behind = true;
      continue;
    }
    before = true;
    const Eigen::Array2d at = p.head<2>().array() / p.z();
    lower = lower.min(at);
    upper = upper.max(at);
  }
  if (!before) return {0, 0, -1, -1};
  if (behind) return whole(lens);
  // Without distortion the four corners do; else the rectangle's border bulges between them.
  const int pieces = lens.distorts() ? 32 : 1;
  const double margin = lens.distorts() ? 2.0 : 0.0;
  Eigen::Array2d first = Eigen::Array2d::Constant(1e300), last = -first;
  for (int i = 0; i <= pieces; ++i) {
    const double s = static_cast<double>(i) / pieces, x = lower.x() + s * (upper.x() - lower.x()),
                 y = lower.y() + s * (upper.y() - lower.y());
    for (const Vec3& corner :
         {Vec3(x, lower.y(), 1.0), Vec3(x, upper.y(), 1.0), Vec3(lower.x(), y, 1.0), Vec3(upper.x(), y, 1.0)}) {
      const auto pixel = lens.project(corner);
      if (!pixel) return whole(lens);
      first = first.min(pixel->array());
      last = last.max(pixel->array());
    }
  }
  const auto clamp = [](double value, int end) { return static_cast<int>(std::clamp(value, -1.0, end + 0.0)); };
  return {std::max(0, clamp(std::floor(first.x() - margin), lens.width)),
          std::max(0, clamp(std::floor(first.y() - margin), lens.height)),
          std::min(lens.width - 1, clamp(std::ceil(last.x() + margin), lens.width)),
          std::min(lens.height - 1, clamp(std::ceil(last.y() + margin), lens.height))};
}

}  // namespace

bool Silhouette::at(int column, int row) const {
  const int x = column - left, y = row - top;
  if (x < 0 || y < 0 || x >= width || y >= height) return false;
  return bits[static_cast<std::size_t>(y) * words_per_row() + static_cast<std::size_t>(x) / 64] >> (x % 64) & 1u;
}

std::vector<Silhouette> silhouettes(const Scenery& scenery, const View& view, double near, double far) {
  const Lens& lens = view.lens;
  const Mat3 turn = view.pose.orientation.toRotationMatrix();
  const Pose bin_in_camera = view.pose.inverse();
  std::vector<Silhouette> all(scenery.part_count());
  in_parallel(all.size(), [&](std::size_t index) {
    const Scenery::Placed part = scenery.part(index);
    if (!part.mesh) return;
    const Rectangle bounds = bounds_of(*part.mesh, bin_in_camera * part.pose, lens);
    if (bounds.empty()) return;
    Silhouette& s = all[index];
    s.left = bounds.left, s.top = bounds.top;
    s.width = bounds.right - bounds.left + 1, s.height = bounds.bottom - bounds.top + 1;
    s.bits.assign(s.words_per_row() * static_cast<std::size_t>(s.height), 0);
    std::vector<Ray> rays;
    std::vector<int> columns;
    std::vector<std::uint8_t> covers(static_cast<std::size_t>(s.width));
    for (int y = 0; y < s.height; ++y) {
      std::uint64_t* row = &s.bits[static_cast<std::size_t>(y) * s.words_per_row()];
      const auto set = [&](int x) {
        row[x / 64] |= std::uint64_t{1} << (x % 64);
        ++s.count;
      };
      const std::uint16_t* label = &view.label[static_cast<std::size_t>(s.top + y) * lens.width + s.left];
      rays.clear();
      columns.clear();
      for (int x = 0; x < s.width; ++x) {
        if (label[x] == part.id + 1) {  // seen is covered
          set(x);
        } else {
          rays.push_back({view.pose.position, turn * lens.ray(s.left + x, s.top + y), near, far});
          columns.push_back(x);
        }
      }
      scenery.blocked_by(index, rays.data(), covers.data(), rays.size());
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (covers[i]) set(columns[i]);
      }
    }
  });
  return all;
}

}  // namespace bin_scenes
