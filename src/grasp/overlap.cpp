#include "grasp/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double cells_of_a_part = 64.0;  ///< columns along the diagonal of the smallest part
constexpr double touching = 2e-3;         ///< / smallest diagonal
constexpr int directions = 16;            ///< directions of the moves that are tried
constexpr std::size_t all_cells = std::numeric_limits<std::size_t>::max();

}  // namespace

Overlaps::Overlaps(const PlacedParts& placed) : up_(placed.up()), across_x_(up_.unitOrthogonal()) {
  across_y_ = up_.cross(across_x_);
  double smallest = std::numeric_limits<double>::infinity();
  for (const PlacedPart& part : placed.all())
    if (part.id >= 0) smallest = std::min(smallest, part.mesh->mesh().bounds().diagonal());
  if (!std::isfinite(smallest)) return;
  cell_ = smallest / cells_of_a_part;
  touching_ = static_cast<float>(touching * smallest);
  for (const PlacedPart& part : placed.all()) all_.push_back(part.id >= 0 ? columns_of(part) : Columns());
}

Overlaps::Columns Overlaps::columns_of(const PlacedPart& part) const {
  std::vector<Vec3> points;  // across, across, along the lift, in cells
  Aabb box;
  for (const Vec3& v : part.mesh->mesh().vertices) {
    const Vec3 x = part.pose * v;
    points.emplace_back(x.dot(across_x_) / cell_, x.dot(across_y_) / cell_, x.dot(up_));
    box.extend(points.back());
  }
  Columns columns;
  columns.x = static_cast<int>(std::ceil(box.lower.x()));
  columns.y = static_cast<int>(std::ceil(box.lower.y()));
  columns.width = std::max(0, static_cast<int>(std::floor(box.upper.x())) - columns.x + 1);
  columns.height = std::max(0, static_cast<int>(std::floor(box.upper.y())) - columns.y + 1);
  const auto count = static_cast<std::size_t>(columns.width) * static_cast<std::size_t>(columns.height);
  columns.low.assign(count, std::numeric_limits<float>::max());
  columns.high.assign(count, std::numeric_limits<float>::lowest());
  for (const Triangle& t : part.mesh->mesh().triangles) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const Vec3 ab = b - a, ac = c - a;
    const double area = ab.x() * ac.y() - ab.y() * ac.x();
    if (std::abs(area) < 1e-9) continue;  // seen from its edge
    const Vec3 lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
    for (int y = static_cast<int>(std::ceil(lower.y())); y <= upper.y(); ++y)
      for (int x = static_cast<int>(std::ceil(lower.x())); x <= upper.x(); ++x) {
        const double u = ((x - a.x()) * ac.y() - (y - a.y()) * ac.x()) / area;
        const double v = (ab.x() * (y - a.y()) - ab.y() * (x - a.x())) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        const auto at = static_cast<std::size_t>(y - columns.y) * static_cast<std::size_t>(columns.width) +
                        static_cast<std::size_t>(x - columns.x);
        const auto z = static_cast<float>(a.z() + u * ab.z() + v * ac.z());
        columns.low[at] = std::min(columns.low[at], z);
        columns.high[at] = std::max(columns.high[at], z);
      }
  }
  return columns;
}

/// Number of columns in which the part, moved by whole cells, is below the other one; counts up to `enough`.
std::size_t Overlaps::covered(const Columns& part, int dx, int dy, const Columns& above, std::size_t enough) const {
  std::size_t count = 0;
  const int first_x = std::max(part.x + dx, above.x),
            last_x = std::min(part.x + dx + part.width, above.x + above.width);
  const int first_y = std::max(part.y + dy, above.y),
            last_y = std::min(part.y + dy + part.height, above.y + above.height);
  for (int y = first_y; y < last_y; ++y) {
    const auto mine = static_cast<std::size_t>(y - part.y - dy) * static_cast<std::size_t>(part.width),
               its = static_cast<std::size_t>(y - above.y) * static_cast<std::size_t>(above.width);
    for (int x = first_x; x < last_x; ++x) {
      const float low = part.low[mine + static_cast<std::size_t>(x - part.x - dx)];
      if (low == std::numeric_limits<float>::max()) continue;
      if (above.high[its + static_cast<std::size_t>(x - above.x)] > low + touching_ && ++count >= enough) return count;
    }
  }
  return count;
}

double Overlaps::area(std::size_t part, std::size_t above) const {
  return cell_ * cell_ * static_cast<double>(covered(all_[part], 0, 0, all_[above], all_cells));
}

PartPick::Overlap Overlaps::of(std::size_t part, const std::vector<std::size_t>& above) const {
  const Columns& mine = all_[part];
  PartPick::Overlap overlap;
  std::size_t footprint = 0;
  for (const float low : mine.low) footprint += low < std::numeric_limits<float>::max();
  std::size_t count = 0;
  for (const std::size_t other : above) count += covered(mine, 0, 0, all_[other], all_cells);
  overlap.area = cell_ * cell_ * static_cast<double>(count);
  overlap.share = footprint > 0 ? std::min(1.0, static_cast<double>(count) / static_cast<double>(footprint)) : 0.0;
  if (count == 0) return overlap;
  const auto is_free = [&](int dx, int dy) {
    return std::all_of(above.begin(), above.end(),
                       [&](std::size_t other) { return covered(mine, dx, dy, all_[other], 1) == 0; });
  };
  const int farthest = std::max(mine.width, mine.height);
  double least = farthest + 1.0;
  for (int k = 0; k < directions; ++k) {
    const double angle = 2.0 * M_PI * k / directions;
    for (double cells = 1.0; cells < least; cells = std::max(cells + 1.0, 1.25 * cells)) {
      const int dx = static_cast<int>(std::lround(cells * std::cos(angle))),
                dy = static_cast<int>(std::lround(cells * std::sin(angle)));
      if (std::hypot(dx, dy) >= least || !is_free(dx, dy)) continue;
      least = std::hypot(dx, dy);
      overlap.move = cell_ * (dx * across_x_ + dy * across_y_);
      break;
    }
  }
  return overlap;
}

}  // namespace bin_scenes
