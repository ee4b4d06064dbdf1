/// Extracts from grasps.json what the pages of `view` and `report` display. The file itself is written by output/.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace bin_scenes {

/// Returns three lists: grippers; grasps: the best free ones, with different parts first; counts: for each gripper, how
/// many grasps are free, and why others are not. Without grasps.json in the folder, they are empty.
nlohmann::ordered_json grasp_view(const std::string& folder);

}  // namespace bin_scenes
