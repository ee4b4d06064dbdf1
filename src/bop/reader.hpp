/// Reads BOP scenes of any generator, or of real images, and converts them to poses in one world frame for an audit.
/// Images are read by files.hpp.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bop/layout.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

struct BopPart {
  int object = 0;                  ///< BOP's obj_id of the model
  Pose in_camera;                  ///< pose of the model in the camera frame (m)
  Pose in_world;                   ///< pose of the model in the world frame (m), whose z axis points up
  std::optional<double> visible;   ///< visible fraction that the data set states (visib_fract)
  std::optional<long> px_visible;  ///< number of visible pixels that the data set states (px_count_visib)
  std::optional<int> id;           ///< number of the instance; only data sets of this project state it
};

/// One image of a heap: its camera, and the parts that it shows.
struct BopView {
  std::filesystem::path scene;  ///< folder of the scene
  std::string suffix;           ///< suffix of the names of its files: "" or "_SENSOR"
  int image = 0;                ///< number of the image, BOP's im_id
  std::array<double, 9> k{};    ///< camera matrix (px), row-major
  double depth_scale = 1e-3;    ///< m, depth of one count of the depth image
  Pose camera;                  ///< transform from the camera frame to the world frame
  std::vector<BopPart> parts;

  BopFiles files() const { return {scene, suffix}; }
};

struct BopReadOptions {
  std::string sensor;  ///< the sensor to read, in a data set with several; empty: the first one
  std::optional<Vec3>
      up;              ///< upward direction in the world of the data set, or in the camera frame if there is no world
  std::string models;  ///< folder of the models; empty: the folder `models` beside or above the scenes
};

struct BopSet {
  std::map<int, std::string> models;  ///< path of the mesh of each object that occurs in the scenes, by obj_id
  bool world_stated = true;  ///< false: images have no cam_R_w2c; `up` is then taken as the reverse of the camera axis
  std::vector<BopView> views;  ///< all images, in the order of scenes and images
};

/// Reads all folders with scene_gt*.json at `root` or up to three levels below it. Throws an input Error that names
/// file and image if something is missing, damaged or implausible: models, matrices that are no rotations, lengths that
/// are not in millimetres.
BopSet read_bop_set(const std::string& root, const BopReadOptions& options = {});

}  // namespace bin_scenes
