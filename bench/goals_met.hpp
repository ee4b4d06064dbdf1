/// The goals of a scene, and how many scenes meet them.
#pragma once

#include "framework/table.hpp"

#include <vector>

namespace bin_scenes::bench {

/// Rows of judged_scene() over several seeds as one, with the number of those that meet every goal and the worst seed
/// of each goal beside the median. The first that failed instead, if one did.
Row over_all(std::vector<Row> scenes);

}  // namespace bin_scenes::bench
