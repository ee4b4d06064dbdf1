/// The colours in which pictures, pages and markers draw what a scene contains, so that a part has the same colour in
/// all outputs. They are not the optical surfaces that sensors see.
#pragma once

#include "bin_scenes/core/types.hpp"

namespace bin_scenes {

/// Returns the colour of a part (red, green, blue; 0 to 1). Hues are a golden angle apart, so that parts with
/// neighbouring ids differ strongly. Saturation (0.42 to 0.60) and value (0.83 to 0.97) change, so that equal hues
/// still differ.
Vec3 part_colour(int id);

/// The colour of the table.
inline const Vec3 table_colour(0.86, 0.80, 0.70);

}  // namespace bin_scenes
