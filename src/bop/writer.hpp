/// The folder of a scene in BOP's layout by scenes, from images that are made.
#pragma once

#include "bop/image.hpp"
#include "bop/layout.hpp"

namespace bin_scenes {

/// The scene's folder of BOP's layout by scenes. `objects`: how many models the data set has. `run_lengths`: masks are
/// in scene_mask.json, scene_mask_visib.json and scene_gt_coco.json instead of PNG files.
void write_bop(const std::string& directory, const std::vector<BopImage>& images, const BopLayout& layout = {},
               const std::string& split = "train", std::size_t objects = 0, bool run_lengths = false);

/// scene_gt_coco.json, as bop_toolkit's calc_gt_coco writes it, with boxes of whole silhouettes.
/// @param places  of the images, all of one sensor
nlohmann::ordered_json bop_coco(const std::vector<const BopImage*>& images, const std::vector<BopPlace>& places,
                                std::size_t objects);

}  // namespace bin_scenes
