/// One image of a scene as BOP describes it: poses, boxes, masks and visible fractions. It is computed once and written
/// in both layouts, folders of scenes and samples for shards.
#pragma once

#include "bin_scenes/output/bop_layout.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/mask_png.hpp"
#include "output/png.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

constexpr double millimetres = 1e3;  ///< BOP's unit, a metre
nlohmann::ordered_json in_mm(const Vec3& v);

struct BopImage {
  nlohmann::ordered_json camera;  ///< entry of scene_camera.json
  nlohmann::ordered_json truth;   ///< list of scene_gt.json, one entry a part
  nlohmann::ordered_json info;    ///< list of scene_gt_info.json
  int width = 0, height = 0;
  std::vector<std::uint16_t> counts;  ///< depth, in counts of depth_scale
  std::vector<std::uint8_t> gray;
  const RangeImage* seen = nullptr;  ///< for its SNR, true labels and normals; has to outlive this
  std::vector<int> ids;              ///< ids of the parts, by entry
  std::vector<MaskBox> visible;      ///< by entry
  /// Boxes of the silhouettes, by entry; if there are fewer than `ids`, the others are not known.
  std::vector<MaskBox> whole;
};

std::vector<BopImage> bop_images(const Scene& scene, const std::vector<PartModelPtr>& parts,
                                 const std::vector<RangeImage>& images, const BopOptions& options);

/// The scene's folder of BOP's layout by scenes. `objects`: how many models the data set has. `run_lengths`: masks are
/// in scene_mask.json, scene_mask_visib.json and scene_gt_coco.json instead of PNG files.
void write_bop(const std::string& directory, const std::vector<BopImage>& images, const BopLayout& layout = {},
               const std::string& split = "train", std::size_t objects = 0, bool run_lengths = false);
/// {entry: {counts, size}}, as in mask.json of BOP's layout by images.
nlohmann::ordered_json run_lengths_of(const std::vector<MaskBox>& masks, int width, int height);

/// scene_gt_coco.json, as bop_toolkit's calc_gt_coco writes it, with boxes of whole silhouettes.
/// @param places  of the images, all of one sensor
nlohmann::ordered_json bop_coco(const std::vector<const BopImage*>& images, const std::vector<BopPlace>& places,
                                std::size_t objects);

std::string six_digits(std::size_t number);

/// Samples of BOP's layout by images, to be packed into shards: {scene:06d}_{image:06d}.{depth.png, gray.tiff,
/// camera.json, gt.json, gt_info.json, mask.json, mask_visib.json}, of colour images rgb.png, and beside BOP's files
/// of pictures of 16 bits image.png, and snr.png, truth_labels.png and truth_normal.png.
void write_bop_samples(const std::string& directory, std::size_t scene, const std::vector<BopImage>& images);
/// grasps.json beside them, the same for all images of the scene.
void write_grasp_samples(const std::string& directory, const Scene& scene, std::size_t number,
                         const SceneGrasps& grasps, const Request& request);

/// Run lengths of a mask, column by column from the left, each from the top; the first run is one of zeros (COCO).
std::vector<std::size_t> run_lengths(const MaskBox& mask, int width, int height);

}  // namespace bin_scenes
