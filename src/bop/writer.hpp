/// Writes the folder of one scene in BOP's layout by scenes. The images were computed before (image.hpp), and the paths
/// come from layout.hpp.
#pragma once

#include "bop/image.hpp"
#include "bop/layout.hpp"

namespace bin_scenes {

/// Writes the folder of a scene. Throws an environment Error if it cannot be written.
/// @param objects      number of models in the data set
/// @param run_lengths  write masks to scene_mask.json,
///                     scene_mask_visib.json and scene_gt_coco.json,
///                     instead of
void write_bop(const std::string& directory, const std::vector<BopImage>& images, const BopLayout& layout = {},
               const std::string& split = "train", std::size_t objects = 0, bool run_lengths = false);

/// Returns the contents of scene_gt_coco.json as bop_toolkit's calc_gt_coco writes them. Boxes are those of whole
/// silhouettes.
/// @param places  place of each image in the layout; all images are of one sensor
nlohmann::ordered_json bop_coco(const std::vector<const BopImage*>& images, const std::vector<BopPlace>& places,
                                std::size_t objects);

}  // namespace bin_scenes
