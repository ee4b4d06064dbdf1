/// The names and paths of a BOP data set whose folders are scenes (github.com/thodan/bop_toolkit,
/// docs/bop_datasets_format.md, bop_toolkit_lib/dataset_params.py). No other file contains these names, and this one
/// writes nothing.
#pragma once

#include "bin_scenes/config/formats.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace bin_scenes {

constexpr double bop_least_visible = 0.1;  ///< visible fraction below which bop_toolkit's evaluation ignores an object

/// Formats a number with leading zeros, as BOP does for scenes, images, masks and objects.
std::string six_digits(std::size_t number);

/// The folders and files of one image in its layout.
struct BopPlace {
  std::string sensor;
  std::string suffix;     ///< suffix of the names of folders and JSON files: "" or "_SENSOR"
  std::size_t image = 0;  ///< the image's number, BOP's im_id
  struct File {
    std::string modality, folder, extension;
  };
  std::vector<File> files;

  /// Path of one of `files` below the folder of the scene.
  std::string path_of(const File& file) const;
};
/// Returns the place of each image of a scene. @param split  name of the folder of the scene's split; readers expect
/// grey pictures of "train_pbr" also as RGB
std::vector<BopPlace> bop_places(const BopLayout& layout, const std::vector<Sensor>& sensors, const std::string& split);

/// Returns the path of a picture of the scene, relative to the scene's folder.
std::string bop_picture(const BopLayout& layout);
/// Returns the suffix of the files of the sensor on which pose estimators are evaluated.
std::string bop_suffix(const BopLayout& layout);

/// Paths of the files of one sensor in the folder of a scene. A kind of masks is "mask" or "mask_visib".
struct BopFiles {
  std::filesystem::path scene;
  std::string suffix;

  std::filesystem::path camera() const { return json("camera"); }
  std::filesystem::path truth() const { return json("gt"); }
  std::filesystem::path info() const { return json("gt_info"); }
  std::filesystem::path coco() const { return json("gt_coco"); }
  std::filesystem::path run_lengths(const std::string& kind) const { return json(kind); }
  /// Returns the folder of the images or masks of a kind.
  std::filesystem::path folder(const std::string& kind) const { return scene / (kind + suffix); }
  std::filesystem::path mask(const std::string& kind, std::size_t image, std::size_t entry) const;

 private:
  std::filesystem::path json(const std::string& what) const { return scene / ("scene_" + what + suffix + ".json"); }
};
/// Returns the suffixes of the sensors for which a folder has a scene_gt file, sorted; none if it is no scene.
std::vector<std::string> bop_suffixes_in(const std::filesystem::path& folder);

/// Return the paths of models_info.json and of the mesh of an object in a folder of models.
std::filesystem::path bop_models_info(const std::filesystem::path& models);
std::filesystem::path bop_model_file(const std::filesystem::path& models, std::size_t object);

}  // namespace bin_scenes
