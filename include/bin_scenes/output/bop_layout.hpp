/// The paths of the images of a scene in a BOP data set whose folders are scenes (github.com/thodan/bop_toolkit,
/// docs/bop_datasets_format.md, bop_toolkit_lib/dataset_params.py). write_bop() and the packing of data sets use these
/// paths; this header writes nothing.
#pragma once

#include "bin_scenes/config/formats.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// The folders and files of one image in its layout.
struct BopPlace {
  std::string sensor;
  std::string suffix;     ///< suffix of the names of folders and JSON files: "" or "_SENSOR"
  std::size_t image = 0;  ///< the image's number, BOP's im_id
  struct File {
    std::string modality, folder, extension;
  };
  std::vector<File> files;
};
/// Returns the place of each image of a scene. @param split  name of the folder of the scene's split; readers expect
/// grey pictures of "train_pbr" also as RGB
std::vector<BopPlace> bop_places(const BopLayout& layout, const std::vector<Sensor>& sensors, const std::string& split);

/// Returns the path of a picture of the scene, relative to the scene's folder.
std::string bop_picture(const BopLayout& layout);

}  // namespace bin_scenes
