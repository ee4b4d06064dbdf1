/// By how much others cover a part, seen along its lift: in columns of a grid across it.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

#include <vector>

namespace bin_scenes {

class Overlaps {
 public:
  explicit Overlaps(const PlacedParts& placed);

  /// m2 over which a part, by index into PlacedParts::all(), is below another one.
  double area(std::size_t part, std::size_t above) const;
  /// Over which it is below any of several, and the shortest move across the lift that frees it of them.
  PartPick::Overlap of(std::size_t part, const std::vector<std::size_t>& above) const;

 private:
  /// Lowest and highest points of a part's surface in each column, and its place in the grid.
  struct Columns {
    int x = 0, y = 0, width = 0, height = 0;
    std::vector<float> low, high;  ///< m along the lift; low above high: nothing there
  };
  Columns columns_of(const PlacedPart& part) const;
  std::size_t covered(const Columns& part, int dx, int dy, const Columns& above, std::size_t enough) const;

  Vec3 up_, across_x_, across_y_;
  double cell_ = 0.0;      ///< m
  float touching_ = 0.0f;  ///< m: what is higher by no more only touches
  std::vector<Columns> all_;
};

}  // namespace bin_scenes
