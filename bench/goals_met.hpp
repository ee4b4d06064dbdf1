/// The goals of accuracy, and which scenes meet them.
#pragma once

#include "framework/table.hpp"

#include <vector>

namespace bin_scenes::bench {

/// Rows of judged_scenes() over several seeds as one, with the worst seed of each goal beside the median, and counted:
/// meets_own, scenes at rest, whole and within the goals of overlap by their own report; judged, those that the referee
/// saw; meets_all, those of the judged that meet every goal. The first that failed instead, if one did.
Row over_all(std::vector<Row> scenes);

}  // namespace bin_scenes::bench
