/// Sorts points of a part into the cells of a regular grid, to find the points near a given one. It is used while a
/// shape is made, not during a step.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <array>
#include <vector>

namespace bin_scenes::sphere {

class PointGrid {
 public:
  /// `reach` (m) is the radius of most searches; searches with other radii are correct as well.
  PointGrid(std::vector<Vec3> points, double reach);

  /// Returns whether visit(index) was true for any point within `radius` (m) of `place`; stops at the first such point.
  template <class Visit>
  bool any_within(const Vec3& place, double radius, Visit&& visit) const {
    if (points_.empty()) return false;
    const Cell lower = cell_of(place - Vec3::Constant(radius)), upper = cell_of(place + Vec3::Constant(radius));
    for (int z = lower[2]; z <= upper[2]; ++z)
      for (int y = lower[1]; y <= upper[1]; ++y) {
        const std::size_t row = index_of({0, y, z});
        for (std::size_t i = first_[row + lower[0]]; i < first_[row + upper[0] + 1]; ++i)
          if ((points_[order_[i]] - place).squaredNorm() <= radius * radius && visit(order_[i])) return true;
      }
    return false;
  }

 private:
  using Cell = std::array<int, 3>;
  Cell cell_of(const Vec3& point) const;  ///< cell of a point; the nearest cell for a point outside of the grid
  std::size_t index_of(const Cell& cell) const {
    return cell[0] + cells_[0] * (cell[1] + static_cast<std::size_t>(cells_[1]) * cell[2]);
  }

  std::vector<Vec3> points_;
  Vec3 origin_ = Vec3::Zero();
  double cell_ = 1.0;
  Cell cells_ = {1, 1, 1};
  std::vector<std::size_t> order_;  ///< indices of the points, sorted by cell
  std::vector<std::size_t> first_;  ///< start of each cell in order_
};

}  // namespace bin_scenes::sphere
