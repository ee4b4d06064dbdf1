/// BOP's layout by images: samples, to be packed into shards. dataset/shards.hpp packs the samples into tar files and
/// removes them.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bop/image.hpp"

namespace bin_scenes {

/// {scene:06d}_{image:06d}.{depth.png, gray.tiff, camera.json, gt.json, gt_info.json, mask.json, mask_visib.json}, of
/// colour images rgb.png, and beside BOP's files of pictures of 16 bits image.png, and snr.png, truth_labels.png and
/// truth_normal.png.
void write_bop_samples(const std::string& directory, std::size_t scene, const std::vector<BopImage>& images);
/// grasps.json beside them, the same for all images of the scene.
void write_grasp_samples(const std::string& directory, const Scene& scene, std::size_t number,
                         const SceneGrasps& grasps, const Request& request);

}  // namespace bin_scenes
