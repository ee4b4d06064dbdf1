/// Draws triangles where projection keeps lines straight, and asks rays where it does not. What the view shows already
/// is not asked again.
#include "bin_scenes/raster/silhouettes.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "core/in_parallel.hpp"
#include "raster/drawing.hpp"
#include "raster/spans.hpp"

#include <algorithm>
#include <bitset>
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

/// Corners of a mesh in the optical frame.
std::vector<Vec3> corners_of(const Mesh& mesh, const Pose& mesh_in_camera) {
  std::vector<Vec3> corners;
  corners.reserve(mesh.vertices.size());
  const Mat3 turn = mesh_in_camera.orientation.toRotationMatrix();
  for (const Vec3& vertex : mesh.vertices) corners.push_back(turn * vertex + mesh_in_camera.position);
  return corners;
}

/// Bounds of all pixels a mesh can cover; from its corners in the plane z = 1, where straight lines stay straight.
Rectangle bounds_of(const std::vector<Vec3>& corners, const Lens& lens) {
  Eigen::Array2d lower = Eigen::Array2d::Constant(1e300), upper = -lower;
  bool behind = false, before = false;
  for (const Vec3& p : corners) {
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

void set(Silhouette& s, int x, int y) {
  s.bits[static_cast<std::size_t>(y) * s.words_per_row() + static_cast<std::size_t>(x) / 64] |= std::uint64_t{1}
                                                                                                << (x % 64);
}

/// Where lines stay straight and no triangle leaves the range, its projection says which pixel centres it covers. That
/// is what a ray through each would find, at a fifth of the time: triangles are few, and pixels many.
void fill_by_triangles(Silhouette& s, const Mesh& mesh, const std::vector<Vec3>& corners, const Lens& lens) {
  std::vector<ImageCorner> at;  // in the rectangle
  at.reserve(corners.size());
  for (const Vec3& p : corners) {
    const double y = p.y() / p.z();
    at.push_back({lens.fx * p.x() / p.z() + lens.skew * y + lens.cx - s.left, lens.fy * y + lens.cy - s.top, 0.0});
  }
  for (const Triangle& triangle : mesh.triangles) {
    const ImageCorner* const corner[3] = {&at[triangle[0]], &at[triangle[1]], &at[triangle[2]]};
    for_spans(corner, 0, s.height - 1, s.width, [&](int y, int first, int last) {
      for (int x = first; x <= last; ++x) set(s, x, y);
    });
  }
}

/// What the view does not show of the part is asked by rays.
void fill_by_rays(Silhouette& s, const Scenery& scenery, std::size_t part, const View& view, double near, double far) {
  const Mat3 turn = view.pose.orientation.toRotationMatrix();
  const int label = scenery.part(part).id + 1;
  std::vector<Ray> rays;
  std::vector<int> columns;
  std::vector<std::uint8_t> covers(static_cast<std::size_t>(s.width));
  for (int y = 0; y < s.height; ++y) {
    rays.clear();
    columns.clear();
    for (int x = 0; x < s.width; ++x) {
      if (view.label[static_cast<std::size_t>(s.top + y) * view.lens.width + s.left + x] == label) continue;
      rays.push_back({view.pose.position, turn * view.lens.ray(s.left + x, s.top + y), near, far});
      columns.push_back(x);
    }
    scenery.blocked_by(part, rays.data(), covers.data(), rays.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (covers[i]) set(s, columns[i], y);
    }
  }
}

/// Pixels that show the part belong to it, however near to its edge; then counts.
void finish(Silhouette& s, const View& view, int label) {
  for (int y = 0; y < s.height; ++y) {
    const std::uint16_t* row = &view.label[static_cast<std::size_t>(s.top + y) * view.lens.width + s.left];
    for (int x = 0; x < s.width; ++x) {
      if (row[x] == label) set(s, x, y);
    }
  }
  for (const std::uint64_t word : s.bits) s.count += std::bitset<64>(word).count();
  BIN_SCENES_ASSERT(s.count <= static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height));
}

}  // namespace

bool Silhouette::at(int column, int row) const {
  const int x = column - left, y = row - top;
  if (x < 0 || y < 0 || x >= width || y >= height) return false;
  return bits[static_cast<std::size_t>(y) * words_per_row() + static_cast<std::size_t>(x) / 64] >> (x % 64) & 1u;
}

std::vector<Silhouette> silhouettes(const Scenery& scenery, const View& view, double near, double far) {
  const Pose bin_in_camera = view.pose.inverse();
  std::vector<Silhouette> all(scenery.part_count());
  in_parallel(all.size(), [&](std::size_t index) {
    const Scenery::Placed part = scenery.part(index);
    if (!part.mesh) return;
    const std::vector<Vec3> corners = corners_of(*part.mesh, bin_in_camera * part.pose);
    const Rectangle bounds = bounds_of(corners, view.lens);
    if (bounds.empty()) return;
    Silhouette& s = all[index];
    s.left = bounds.left, s.top = bounds.top;
    s.width = bounds.right - bounds.left + 1, s.height = bounds.bottom - bounds.top + 1;
    BIN_SCENES_ASSERT(bounds.left >= 0 && bounds.top >= 0 && bounds.right < view.lens.width);
    BIN_SCENES_ASSERT(bounds.bottom < view.lens.height);
    s.bits.assign(s.words_per_row() * static_cast<std::size_t>(s.height), 0);
    const bool in_range =
        std::all_of(corners.begin(), corners.end(), [&](const Vec3& p) { return p.z() > near && p.z() < far; });
    if (in_range && !view.lens.distorts()) {
      fill_by_triangles(s, *part.mesh, corners, view.lens);
    } else {
      fill_by_rays(s, scenery, index, view, near, far);
    }
    finish(s, view, part.id + 1);
  });
  return all;
}

SeenWithMasks see(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far) {
  SeenWithMasks seen;
  if (std::optional<View> view = drawn(scenery, lens, pose, near, far, &seen.alone)) {
    seen.view = std::move(*view);
    return seen;
  }
  seen.view = render(scenery, lens, pose, near, far);
  seen.alone = silhouettes(scenery, seen.view, near, far);
  return seen;
}

}  // namespace bin_scenes
