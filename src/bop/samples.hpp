/// BOP's layout by images: samples, to be packed into shards. dataset/shards.hpp packs the samples into tar files and
/// removes them.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bop/image.hpp"

namespace bin_scenes {

/// Writes for each image {scene:06d}_{image:06d}.{depth.png, gray.tiff, camera.json, gt.json, gt_info.json, mask.json,
/// mask_visib.json}, also rgb.png for colour images, image.png for images of 16 bits, and snr.png, truth_labels.png and
/// truth_normal.png.
void write_bop_samples(const std::string& directory, std::size_t scene, const std::vector<BopImage>& images);
/// Writes {scene:06d}_{image:06d}.grasps.json for each image; it is the same for all images of the scene.
void write_grasp_samples(const std::string& directory, const Scene& scene, std::size_t number,
                         const SceneGrasps& grasps, const Request& request);

}  // namespace bin_scenes
