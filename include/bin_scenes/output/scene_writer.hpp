/// Writes the files of a finished scene: poses, grasps, clouds and images. Each file is written under a
/// temporary name and renamed, so that no file is ever incomplete. A full disk or an unwritable folder is an
/// environment Error. docs/use/outputs.md describes the files for users; the layout of whole data sets is the task of
/// src/dataset.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the text of scene.json (format "bin_scenes/1"). Numbers are written so that reading restores the same bits;
/// NaN is null, and so is the pose of a part that was never poured. Two runs of a request on one device class differ in
/// report.wall_s, report.stages_ms and report.counters only. With `images`, each sensor has a block `truth`: for each
/// part its visible fraction, boxes and pixel counts.
/// @param loaded  its models are needed only with images
std::string scene_json(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images = {});
/// Returns the contents of that file as a struct.
SceneFile scene_file(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images = {});

/// Returns the text of grasps.json (format "bin_scenes/grasps/1", docs/use/outputs.md).
std::string grasps_json(const SceneGrasps& grasps, const Scene& scene, const Request& request);

/// Returns the entry of a gripper in that file, in one line.
std::string gripper_text(const Gripper& gripper);

/// Returns the contents of a numpy file (float32) with the free grasps of one gripper, in the frame of the sensor.
/// Grasps of two fingers have 17 columns for graspnetAPI's GraspGroup, and grasps from inside a hole are omitted
/// because that format cannot represent them. Grasps of a cup have 8 columns for suctionnetAPI's SuctionGroup.
/// @param gripper  index into Request::grippers
std::string grasps_npy(const SceneGrasps& grasps, const Sensor& sensor, const Request& request, std::size_t gripper);
/// Returns the name of a gripper for use in file names: every character other than a letter, a digit or one of "-._"
/// becomes "_".
std::string file_name_of(const Gripper& gripper);

/// Writes two kinds of label images in the true view of the camera. `SENSOR_layers.png` (8 bit): 0 bin and background,
/// 1 parts that can be lifted, 2 parts that are partly covered, 3 parts of which at least half of the footprint is
/// covered. `SENSOR_suction_GRIPPER.png` for each cup (16 bit): score * 65535 of the nearest grasp that was tried
/// within the radius of the cup, and 0 where that grasp is not free or none was tried.
void write_grasp_maps(const std::string& directory, const RangeImage& image, const SceneGrasps& grasps,
                      const Request& request);

/// Writes a text file.
void write_text(const std::string& path, const std::string& text);
/// Makes a directory and those above it.
void make_directory(const std::filesystem::path& path);

/// Writes a cloud as a PCD file: organised, binary, in the optical frame, with the pose as VIEWPOINT. Fields: x y z
/// normal_x normal_y normal_z intensity label validity truth_normal_x truth_normal_y truth_normal_z snr. `label` is 0
/// for background and bin, and id + 1 for a part; `validity` is a code of scene/validity.hpp; the true normal is that
/// of the surface which the pixel sees, whether it was measured or not.
void write_pcd(const std::string& path, const RangeImage& image);
/// Writes the same cloud as binary little-endian PLY, in which the normals are called nx ny nz and truth_nx truth_ny
/// truth_nz.
void write_ply(const std::string& path, const RangeImage& image);

/// Writes the images of a sensor as PNG files: all channels of image_channel.hpp, and pictures for viewing.
///
/// 16 bit: <sensor>_depth.png and <sensor>_truth_depth.png contain counts of Sensor::depth_scale, where 0 means not
/// valid and 65535 means that depth or more; <sensor>_labels.png contains id + 1, and 0 where nothing was measured;
/// <sensor>_truth_labels.png contains the labels of what is truly seen; <sensor>_snr.png contains tenths.
///
/// 8 bit: <sensor>_validity.png and <sensor>_truth_normal.png.
///
/// For viewing: <sensor>.png is shaded; <sensor>_depth_picture.png has a scale in metres; <sensor>_validity_picture.png
/// has a legend.
void write_pngs(const std::string& directory, const RangeImage& image);

/// Writes a mesh as binary little-endian PLY; every coordinate is multiplied by `scale`.
void write_ply(const std::string& path, const Mesh& mesh, double scale = 1.0);

/// A function that writes a scene into a bag with the topics and types of the live node. The ROS layer registers it if
/// the program contains that layer.
using BagWriter =
    std::function<void(const std::string& path, const Scene&, const LoadedRequest&, const std::vector<RangeImage>&)>;
void register_bag_writer(BagWriter writer);
/// Returns the registered function; empty in a program without ROS.
const BagWriter& bag_writer();

/// Writes a scene to an MCAP file, as BagWriter writes it to a bag.
using McapWriter = std::function<void(const std::string& path, McapProfile, const Scene&, const LoadedRequest&,
                                      const std::vector<RangeImage>&)>;
void register_mcap_writer(McapWriter writer);
/// Returns the registered function; empty in a program without ROS.
const McapWriter& mcap_writer();
/// Returns the profile that an MCAP file names in its header; empty if the file is not an MCAP file.
std::string mcap_profile_in(const std::string& path);

}  // namespace bin_scenes
