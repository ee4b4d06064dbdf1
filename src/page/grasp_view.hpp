/// Extracts from grasps.json what the pages of `view` and `report` display. The file itself is written by output/.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace bin_scenes {

/// grippers; grasps: the best free ones, of different parts first; counts: by gripper how many are free, and why the
/// others are not. Empty lists if the folder of the scene has no grasps.json.
nlohmann::ordered_json grasp_view(const std::string& folder);

}  // namespace bin_scenes
