/// Files of a finished scene. Each is written under a temporary name and renamed, so that no file is ever incomplete.
/// A full disk or an unwritable directory is an environment Error.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/part/symmetry.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes {

/// scene.json as text (format "bin_scenes/1"). Numbers read back as the same bits; NaN is null, and so is the pose of a
/// part that was never poured. Only report.wall_s, report.stages_ms and report.counters may differ between two runs of
/// a request on one class of device. `images` add a block `truth` to each sensor: per part its visible fraction, boxes
/// and counts of pixels.
/// @param loaded  its models are needed with images only
std::string scene_json(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images = {});
/// The same as a struct.
SceneFile scene_file(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images = {});

/// grasps.json as text (format "bin_scenes/grasps/1"): docs/use/outputs.md.
std::string grasps_json(const SceneGrasps& grasps, const Scene& scene, const Request& request);

/// Free grasps of one gripper as a file of numpy, float32, in the frame of the sensor. Two fingers: 17 columns for
/// graspnetAPI's GraspGroup, whose format has no grasps from within. A cup: 8 columns for suctionnetAPI's SuctionGroup.
/// @param gripper  index into Request::grippers
std::string grasps_npy(const SceneGrasps& grasps, const Sensor& sensor, const Request& request, std::size_t gripper);
/// The gripper's name as a part of file names: what is neither letter nor digit nor one of -._ becomes _.
std::string file_name_of(const Gripper& gripper);

/// `SENSOR_layers.png`, 8 bit: 0 bin and background, 1 parts that can be lifted, 2 partly covered, 3 covered by half of
/// their footprint and more. `SENSOR_suction_GRIPPER.png` for each cup, 16 bit: score * 65535 of the nearest cup that
/// was tried within its radius, 0 where it is not free or none was tried. Both show the true view of the camera.
void write_grasp_maps(const std::string& directory, const RangeImage& image, const SceneGrasps& grasps,
                      const Request& request);

void write_text(const std::string& path, const std::string& text);

/// Organised, binary, optical frame, pose as VIEWPOINT; fields x y z normal_x normal_y normal_z intensity label
/// validity truth_normal_x truth_normal_y truth_normal_z snr, where label is 0 for background and bin, id + 1 for a
/// part, validity a code of sensor/validity.hpp, and the true normal that of what the pixel sees, measured or not.
void write_pcd(const std::string& path, const RangeImage& image);
/// The same as binary little-endian PLY; normals are called nx ny nz there, and truth_nx truth_ny truth_nz.
void write_ply(const std::string& path, const RangeImage& image);

/// 16 bit: <sensor>_depth.png and <sensor>_truth_depth.png, counts of Sensor::depth_scale, 0 = not valid, 65535 = that
/// many or more; <sensor>_labels.png, id + 1, 0 where nothing was measured; <sensor>_truth_labels.png, of what is truly
/// seen. <sensor>_snr.png, in tenths. 8 bit: <sensor>_validity.png; <sensor>_truth_normal.png. To look at:
/// <sensor>.png, shaded; <sensor>_depth_picture.png with a bar in metres; <sensor>_validity_picture.png with a legend.
void write_pngs(const std::string& directory, const RangeImage& image);

/// One scene in the layout of the BOP challenge (github.com/thodan/bop_toolkit, docs/bop_datasets_format.md): a camera
/// is an image of the scene; lengths in mm; depth/, gray/, mask/, mask_visib/, scene_gt.json, scene_gt_info.json,
/// scene_camera.json. Depth in counts of depth_scale. `parts[line]` are the models.
///
/// BOP numbers masks by the position of the entry in scene_gt; here the number is the part's id. An entry carries its
/// `id` and stands at that position if possible. If parts were not poured, the last entries take the free positions,
/// and their masks are stored under both numbers.
void write_bop(const std::string& directory, const Scene& scene, const std::vector<PartModelPtr>& parts,
               const std::vector<RangeImage>& images);
/// How BOP's files state what is visible, and which object a part is.
struct BopOptions {
  /// 0: a pixel shows the part that is truly seen there. Else, in m: it shows every part that lies no deeper than so
  /// far behind the measured surface, or where nothing was measured (bop_toolkit's rule for images of real cameras).
  double tolerance = 0.0;
  std::vector<int> object_ids;  ///< by part line; empty: bop_object_ids()
};
/// The folder models of a BOP data set: obj_<obj_id>.ply and models_info.json (mm) with diameter and symmetries: those
/// given, by part line, else those found on the mesh. `for_evaluation`: the folder models_eval, whose meshes have
/// vertices evenly over their surface.
void write_bop_models(const std::string& directory, const std::vector<PartModelPtr>& parts,
                      const std::vector<Symmetries>& given = {}, bool for_evaluation = false);
/// Entry of models_info.json, JSON (mm): diameter, bounds and symmetries.
std::string bop_model_info(const PartModel& part, const Symmetries& symmetries);
/// BOP's obj_id of each part line: 1, 2, ... in order of first use; lines of the same model share one.
std::vector<int> bop_object_ids(const std::vector<PartModelPtr>& parts);

/// Binary little-endian PLY; every coordinate times `scale`.
void write_ply(const std::string& path, const Mesh& mesh, double scale = 1.0);

/// Writes a scene into a bag with the topics and types of the live node. Set by the ROS rim when it is built in.
using BagWriter =
    std::function<void(const std::string& path, const Scene&, const LoadedRequest&, const std::vector<RangeImage>&)>;
void register_bag_writer(BagWriter writer);
/// Empty without ROS.
const BagWriter& bag_writer();

/// As BagWriter, into an MCAP file.
using McapWriter = std::function<void(const std::string& path, McapProfile, const Scene&, const LoadedRequest&,
                                      const std::vector<RangeImage>&)>;
void register_mcap_writer(McapWriter writer);
/// Empty without ROS.
const McapWriter& mcap_writer();
/// The profile that an MCAP file names in its header; empty if the file is not MCAP.
std::string mcap_profile_in(const std::string& path);

}  // namespace bin_scenes
