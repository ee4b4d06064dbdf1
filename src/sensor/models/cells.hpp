/// A pixel in sixteen cells. No two are asked in one column or row of it, so that an edge along either moves from cell
/// to cell.
#pragma once

#include <algorithm>
#include <iterator>

namespace bin_scenes::cells {

constexpr int side = 4, per_pixel = side * side;  ///< row-major
constexpr int corners[4] = {0, side - 1, per_pixel - side, per_pixel - 1};

/// Where in its pixel a cell is asked, -0.5 to 0.5.
constexpr double across(int k) {
  return (k % side + (k / side + 0.5) / side) / side - 0.5;
}
constexpr double down(int k) {
  return (k / side + (k % side + 0.5) / side) / side - 0.5;
}
inline bool is_corner(int k) {
  return std::find(std::begin(corners), std::end(corners), k) != std::end(corners);
}

}  // namespace bin_scenes::cells
