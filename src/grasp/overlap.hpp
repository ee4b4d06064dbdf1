/// Areas over which parts cover each other, measured in the columns of a horizontal grid. Grasp labels report them, and
/// removal.hpp uses them to choose the part of a blocked set that is lifted first.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

#include <vector>

namespace bin_scenes {

class Overlaps {
 public:
  explicit Overlaps(const PlacedParts& placed);

  /// Returns the area (m2) over which a part is below another one; arguments are indices into PlacedParts::all().
  double area(std::size_t part, std::size_t above) const;
  /// Returns the area over which a part is below several others, and the shortest horizontal move that uncovers it.
  PartPick::Overlap of(std::size_t part, const std::vector<std::size_t>& above) const;

 private:
  /// Lowest and highest point of the surface of a part in each grid column of its bounding rectangle.
  struct Columns {
    int x = 0, y = 0, width = 0, height = 0;
    std::vector<float> low, high;  ///< heights along up_ (m); low > high: the part is not in this column
  };
  Columns columns_of(const PlacedPart& part) const;
  std::size_t covered(const Columns& part, int dx, int dy, const Columns& above, std::size_t enough) const;

  Vec3 up_, across_x_, across_y_;
  double cell_ = 0.0;      ///< m, edge of a grid column
  float touching_ = 0.0f;  ///< m: a part that is above another by less than this only touches it
  std::vector<Columns> all_;
};

}  // namespace bin_scenes
