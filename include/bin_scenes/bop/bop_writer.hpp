/// Writes scenes and models of BOP data sets whose folders are scenes. Each file is written under a temporary name and
/// renamed; a full disk or an unwritable directory is an environment Error.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/part/symmetry.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Writes one scene in the layout of the BOP challenge (github.com/thodan/bop_toolkit, docs/bop_datasets_format.md).
/// Each camera is an image of the scene; lengths are in mm; depth is in counts of depth_scale. The files are depth/,
/// gray/, mask/, mask_visib/, scene_gt.json, scene_gt_info.json and scene_camera.json.
/// @param parts  one model for each entry of the request's list `parts`
///
/// BOP numbers masks by the position of the entry in scene_gt; here the number is the part's id. An entry carries its
/// `id` and is at the position of that number if possible. If parts were not poured, the last entries take the free
/// positions, and their masks are stored under both numbers.
void write_bop(const std::string& directory, const Scene& scene, const std::vector<PartModelPtr>& parts,
               const std::vector<RangeImage>& images);
/// How BOP files state which parts are visible, and which object a part is.
struct BopOptions {
  /// 0: a pixel shows the part that is truly seen there. Otherwise, in m: a pixel shows every part that is at most this
  /// far behind the measured surface, and every part where nothing was measured (bop_toolkit's rule for images of real
  /// cameras).
  double tolerance = 0.0;
  std::vector<int> object_ids;  ///< BOP's obj_id of each entry of Request::parts; empty: those of bop_object_ids()
};
/// Writes the folder `models` of a BOP data set: obj_<obj_id>.ply and models_info.json (mm) with the diameter and the
/// symmetries. The symmetries are those of `given`, by part line, or otherwise those found on the mesh. With
/// `for_evaluation`, it is the folder `models_eval`, whose meshes have vertices spread evenly over their surface.
void write_bop_models(const std::string& directory, const std::vector<PartModelPtr>& parts,
                      const std::vector<Symmetries>& given = {}, bool for_evaluation = false);
/// Returns the entry of a model in models_info.json as JSON (mm): diameter, bounds and symmetries.
std::string bop_model_info(const PartModel& part, const Symmetries& symmetries);
/// Returns BOP's obj_id of each part line: 1, 2, ... in order of first use. Lines with the same model share one number.
std::vector<int> bop_object_ids(const std::vector<PartModelPtr>& parts);

}  // namespace bin_scenes
