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
  int object = 0;
  Pose in_camera;                  ///< m, of the model
  Pose in_world;                   ///< m; z up
  std::optional<double> visible;   ///< visib_fract as stated
  std::optional<long> px_visible;  ///< px_count_visib as stated
  std::optional<int> id;           ///< number of the instance, which only data sets of this project state
};

/// One image of a heap: its camera, and the parts that it shows.
struct BopView {
  std::filesystem::path scene;  ///< folder
  std::string suffix;           ///< suffix of the names of its files: "" or "_SENSOR"
  int image = 0;
  std::array<double, 9> k{};
  double depth_scale = 1e-3;  ///< m a count of the depth image
  Pose camera;                ///< from the camera to the world
  std::vector<BopPart> parts;

  BopFiles files() const { return {scene, suffix}; }
};

struct BopReadOptions {
  std::string sensor;  ///< the sensor to read, in a data set with several; empty: the first one
  std::optional<Vec3>
      up;  ///< upward direction in the world of the data set, or in the camera's frame if the data set states no world
  std::string models;  ///< folder; empty: models beside or above the scenes
};

struct BopSet {
  std::map<int, std::string> models;  ///< path of the mesh by object, of those that scenes show
  bool world_stated = true;    ///< false: images have no cam_R_w2c, and up is taken to be against the camera's axis
  std::vector<BopView> views;  ///< in order of scene and image
};

/// Folders with scene_gt*.json at `root` or up to three levels below it. Throws an input Error, with file and image,
/// for what is missing, damaged or makes no sense: models, matrices that are no rotations, lengths that are not
/// millimetres.
BopSet read_bop_set(const std::string& root, const BopReadOptions& options = {});

}  // namespace bin_scenes
