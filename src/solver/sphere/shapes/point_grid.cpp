#include "solver/sphere/shapes/point_grid.hpp"

#include <algorithm>
#include <numeric>

namespace bin_scenes::sphere {

PointGrid::PointGrid(std::vector<Vec3> points, double reach) : points_(std::move(points)) {
  constexpr double most_cells = 48;  // along a side
  Aabb box;
  for (const Vec3& p : points_) box.extend(p);
  if (!points_.empty()) {
    origin_ = box.lower;
    const double side = box.size().maxCoeff();
    cell_ = std::max(reach, side / most_cells);
    if (!(cell_ > 0.0)) cell_ = 1.0;
    for (int i = 0; i < 3; ++i) cells_[i] = 1 + static_cast<int>(box.size()[i] / cell_);
  }
  first_.assign(index_of({0, 0, cells_[2]}) + 1, 0);
  for (const Vec3& p : points_) ++first_[index_of(cell_of(p)) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  order_.resize(points_.size());
  std::vector<std::size_t> next = first_;
  for (std::size_t i = 0; i < points_.size(); ++i) order_[next[index_of(cell_of(points_[i]))]++] = i;
}

PointGrid::Cell PointGrid::cell_of(const Vec3& point) const {
  Cell cell;
  for (int i = 0; i < 3; ++i)
    cell[i] = static_cast<int>(std::clamp((point[i] - origin_[i]) / cell_, 0.0, cells_[i] - 1.0));
  return cell;
}

}  // namespace bin_scenes::sphere
