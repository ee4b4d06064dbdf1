/// Lists the edges of a part that are near a point, by blocks of cells of its distance field. The test of a sample
/// looks up the block of its point and examines these edges only.
#pragma once

#include "solver/sphere/shapes/field.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace bin_scenes::sphere {

struct Samples;

struct EdgeGrid {
  static constexpr int block = SPHERE_EDGE_BLOCK;
  static constexpr float reach = SPHERE_EDGE_REACH;

  int row = 0, slice = 0;            ///< number of blocks along x; number in one layer of x and y
  std::vector<std::uint32_t> first;  ///< by block, x fastest: start of its list in `edges`; then the size of `edges`
  std::vector<std::uint32_t> edges;  ///< edge lists of all blocks, each in ascending order

  /// Returns the list near `point` (field's frame, anywhere): its first and end index in `edges`. Empty without a grid.
  std::pair<std::uint32_t, std::uint32_t> near(const Field& field, const Vec3f& point) const;
};

/// Makes the edge grid of a part; it is empty for a ball.
EdgeGrid make_edge_grid(const Samples& samples, const Field& field);

}  // namespace bin_scenes::sphere
