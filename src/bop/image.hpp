/// One image of a scene as BOP describes it: poses, boxes, masks and visible fractions. It is computed once and written
/// in both layouts, folders of scenes and samples for shards.
#pragma once

#include "bin_scenes/bop/bop_writer.hpp"
#include "bop/masks.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

constexpr double millimetres = 1e3;           ///< BOP's unit of length: millimetres per metre
nlohmann::ordered_json in_mm(const Vec3& v);  ///< converts a vector from m to a JSON list in mm

struct BopImage {
  nlohmann::ordered_json camera;  ///< entry of the image in scene_camera.json
  nlohmann::ordered_json truth;   ///< list of the image in scene_gt.json, one entry for each part
  nlohmann::ordered_json info;    ///< list of the image in scene_gt_info.json, one entry for each part
  int width = 0, height = 0;
  std::vector<std::uint16_t> counts;  ///< depth image, in counts of depth_scale, row-major
  std::vector<std::uint8_t> gray;     ///< grey image, 0 to 255, row-major
  const RangeImage* seen = nullptr;   ///< the image itself, for SNR, true labels and normals; must outlive this
  std::vector<int> ids;               ///< ids of the parts, by entry of `truth`
  std::vector<MaskBox> visible;       ///< masks of the visible pixels, by entry of `truth`
  /// Masks of the whole silhouettes, by entry of `truth`; if there are fewer than `ids`, the others are unknown.
  std::vector<MaskBox> whole;
  bool whole_known() const { return whole.size() == ids.size(); }
};

std::vector<BopImage> bop_images(const Scene& scene, const std::vector<PartModelPtr>& parts,
                                 const std::vector<RangeImage>& images, const BopOptions& options);

}  // namespace bin_scenes
