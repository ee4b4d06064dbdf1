/// One image of a scene as BOP describes it: poses, boxes, masks and visible fractions. It is computed once and written
/// in both layouts, folders of scenes and samples for shards.
#pragma once

#include "bin_scenes/bop/bop_writer.hpp"
#include "bop/masks.hpp"

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
  bool whole_known() const { return whole.size() == ids.size(); }
};

std::vector<BopImage> bop_images(const Scene& scene, const std::vector<PartModelPtr>& parts,
                                 const std::vector<RangeImage>& images, const BopOptions& options);

}  // namespace bin_scenes
