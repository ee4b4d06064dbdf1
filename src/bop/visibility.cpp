/// Counts and boxes of each part in an image. The depth of a part alone is drawn into its box only.
#include "bop/visibility.hpp"

#include "bin_scenes/sensor/resolve.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr double nearest = 1e-4;  ///< m along the optical axis

/// Depth of a mesh alone on a canvas around the image, three times as wide and as high, where it covers pixel centres.
struct Alone {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<float> depth;  ///< m along the optical axis; 0 = not covered
};

double norm_of_ray(const Lens& lens, double x, double y) {
  const double v = (y - lens.cy) / lens.fy, u = (x - lens.cx - lens.skew * v) / lens.fx;
  return std::sqrt(u * u + v * v + 1.0);
}

/// One triangle, row by row; 1 / depth is linear in the image.
void draw(Alone& canvas, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (std::abs(area) < 1e-12) return;
  const double slope_x = ((b.z() - a.z()) * (c.y() - a.y()) - (c.z() - a.z()) * (b.y() - a.y())) / area;
  const double slope_y = ((c.z() - a.z()) * (b.x() - a.x()) - (b.z() - a.z()) * (c.x() - a.x())) / area;
  const Eigen::Vector3d* const corner[3] = {&a, &b, &c};
  const double low = std::max(std::min({a.y(), b.y(), c.y()}), static_cast<double>(canvas.top));
  const double high = std::min(std::max({a.y(), b.y(), c.y()}), canvas.top + canvas.height - 1.0);
  for (int y = static_cast<int>(std::ceil(low)); y <= static_cast<int>(std::floor(high)); ++y) {
    double first = 1e300, last = -1e300;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &p = *corner[k], &q = *corner[(k + 1) % 3];
      if ((y < p.y() && y < q.y()) || (y > p.y() && y > q.y())) continue;
      const double share = p.y() == q.y() ? 0.0 : (y - p.y()) / (q.y() - p.y());
      for (const double x : {p.x() + share * (q.x() - p.x()), p.y() == q.y() ? q.x() : p.x() + share * (q.x() - p.x())})
        first = std::min(first, x), last = std::max(last, x);
    }
    const int begin = static_cast<int>(std::ceil(std::max(first, static_cast<double>(canvas.left))));
    const int end = static_cast<int>(std::floor(std::min(last, canvas.left + canvas.width - 1.0)));
    float* const row = &canvas.depth[static_cast<std::size_t>(y - canvas.top) * static_cast<std::size_t>(canvas.width)];
    for (int x = begin; x <= end; ++x) {
      const double inverse = a.z() + slope_x * (x - a.x()) + slope_y * (y - a.y());
      if (!(inverse > 0.0)) continue;
      const auto depth = static_cast<float>(1.0 / inverse);
      float& there = row[x - canvas.left];
      if (there == 0.0f || depth < there) there = depth;
    }
  }
}

std::optional<Alone> alone(const Mesh& mesh, const Pose& pose, const Lens& lens) {
  std::vector<Eigen::Vector3d> at;  // column, row, 1 / depth
  at.reserve(mesh.vertices.size());
  const Mat3 turn = pose.orientation.toRotationMatrix();
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 p = turn * vertex + pose.position;
    if (!(p.z() > nearest)) return std::nullopt;
    const double y = p.y() / p.z();
    at.emplace_back(lens.fx * p.x() / p.z() + lens.skew * y + lens.cx, lens.fy * y + lens.cy, 1.0 / p.z());
    left = std::min(left, at.back().x()), right = std::max(right, at.back().x());
    top = std::min(top, at.back().y()), bottom = std::max(bottom, at.back().y());
  }
  const auto within = [](double value, int size) { return std::clamp(value, -1.0 * size, 2.0 * size - 1.0); };
  Alone canvas;
  canvas.left = static_cast<int>(std::ceil(within(left, lens.width)));
  canvas.top = static_cast<int>(std::ceil(within(top, lens.height)));
  canvas.width = std::max(0, static_cast<int>(std::floor(within(right, lens.width))) - canvas.left + 1);
  canvas.height = std::max(0, static_cast<int>(std::floor(within(bottom, lens.height))) - canvas.top + 1);
  canvas.depth.assign(static_cast<std::size_t>(canvas.width) * static_cast<std::size_t>(canvas.height), 0.0f);
  if (!canvas.depth.empty())
    for (const Triangle& t : mesh.triangles) draw(canvas, at[t[0]], at[t[1]], at[t[2]]);
  return canvas;
}

MaskBox empty_mask(const PixelBox& bounds) {
  MaskBox mask;
  if (bounds.empty()) return mask;
  mask.left = bounds.left, mask.top = bounds.top;
  mask.width = bounds.right - bounds.left + 1, mask.height = bounds.bottom - bounds.top + 1;
  mask.inside.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height), 0);
  return mask;
}

void set(MaskBox& mask, int x, int y) {
  mask.inside[static_cast<std::size_t>(y - mask.top) * static_cast<std::size_t>(mask.width) +
              static_cast<std::size_t>(x - mask.left)] = 1;
}

}  // namespace

std::vector<float> distances(const std::vector<float>& depth, const Lens& lens) {
  std::vector<float> distance(depth.size());
  std::size_t i = 0;
  for (int y = 0; y < lens.height; ++y)
    for (int x = 0; x < lens.width; ++x, ++i)
      distance[i] = static_cast<float>(static_cast<double>(depth[i]) * norm_of_ray(lens, x, y));
  return distance;
}

BopVisibility true_visibility(const RangeImage& image, const std::vector<std::uint16_t>& counts, int id,
                              const PixelBox& seen_box, const Mesh& mesh, const Pose& model_in_camera) {
  BopVisibility seen;
  const auto place = static_cast<std::size_t>(id);
  seen.visible = image.visible.at(place);
  seen.all = image.total.at(place);
  seen.visible_mask = visible_mask(image, id, seen_box);
  if (!image.silhouettes.empty()) seen.whole_mask = whole_mask(image.silhouettes.at(place));
  PixelBox all;
  const MaskBox& whole = seen.whole_mask;
  for (int y = whole.top, i = 0; y < whole.top + whole.height; ++y) {
    for (int x = whole.left; x < whole.left + whole.width; ++x, ++i) {
      if (!whole.inside[static_cast<std::size_t>(i)]) continue;
      all.extend(x, y);
      seen.valid +=
          counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)] > 0;
    }
  }
  // What lies beside the image counts as well: rays of the image know nothing of it.
  if (const std::optional<Alone> canvas = alone(mesh, model_in_camera, lens_of(image.true_sensor()))) {
    std::size_t i = 0;
    for (int y = canvas->top; y < canvas->top + canvas->height; ++y) {
      for (int x = canvas->left; x < canvas->left + canvas->width; ++x, ++i) {
        if (canvas->depth[i] == 0.0f) continue;
        all.extend(x, y);
        seen.all += x < 0 || y < 0 || x >= image.width || y >= image.height;
      }
    }
  }
  if (seen.visible > 0) {
    seen.box = all.first_to_last();
    seen.visible_box = seen_box.first_to_last();
  }
  return seen;
}

std::optional<BopVisibility> bop_visibility(const Mesh& mesh, const Pose& model_in_camera, const Lens& lens,
                                            const std::vector<float>& distance, double tolerance) {
  const std::optional<Alone> canvas = alone(mesh, model_in_camera, lens);
  if (!canvas) return std::nullopt;
  BopVisibility seen;
  PixelBox all, inside, visible;
  // Calls visit(x, y, whether the pixel is visible) for pixels of the image; counts and bounds only need one pass,
  // masks another, in the bounds found by the first.
  const auto each = [&](const auto& visit, const auto& beside) {
    std::size_t i = 0;
    for (int y = canvas->top; y < canvas->top + canvas->height; ++y) {
      for (int x = canvas->left; x < canvas->left + canvas->width; ++x, ++i) {
        if (canvas->depth[i] == 0.0f) continue;
        beside(x, y);
        if (x < 0 || y < 0 || x >= lens.width || y >= lens.height) continue;
        const float measured =
            distance[static_cast<std::size_t>(y) * static_cast<std::size_t>(lens.width) + static_cast<std::size_t>(x)];
        const double own = static_cast<double>(canvas->depth[i]) * norm_of_ray(lens, x, y);
        visit(x, y, measured > 0.0f, measured == 0.0f || own - static_cast<double>(measured) <= tolerance);
      }
    }
  };
  each(
      [&](int x, int y, bool valid, bool shown) {
        inside.extend(x, y);
        seen.valid += valid;
        if (!shown) return;
        visible.extend(x, y);
        ++seen.visible;
      },
      [&](int x, int y) {
        all.extend(x, y);
        ++seen.all;
      });
  seen.whole_mask = empty_mask(inside);
  seen.visible_mask = empty_mask(visible);
  each(
      [&](int x, int y, bool, bool shown) {
        set(seen.whole_mask, x, y);
        if (shown) set(seen.visible_mask, x, y);
      },
      [](int, int) {});
  if (seen.visible > 0) {
    seen.box = all.first_to_last();
    seen.visible_box = visible.first_to_last();
  }
  return seen;
}

}  // namespace bin_scenes
