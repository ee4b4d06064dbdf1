/// Divides a pixel into sixteen cells for anti-aliasing. The sample points of no two cells are in the same column or
/// row of the pixel, so that an edge that moves across the pixel changes one cell after the other.
#pragma once

#include <algorithm>
#include <iterator>

namespace bin_scenes::cells {

constexpr int side = 4, per_pixel = side * side;                            ///< cells are numbered row by row
constexpr int corners[4] = {0, side - 1, per_pixel - side, per_pixel - 1};  ///< cells at the corners

/// Returns the position of a cell's sample point within the pixel, -0.5 to 0.5.
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
