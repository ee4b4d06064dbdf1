/// The paths of the images of a scene in BOP's layout by scenes (github.com/thodan/bop_toolkit,
/// docs/bop_datasets_format.md, bop_toolkit_lib/dataset_params.py).
#pragma once

#include "bin_scenes/config/formats.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// One image in its layout.
struct BopPlace {
  std::string sensor;
  std::string suffix;     ///< of folders and of JSON files: "" or "_SENSOR"
  std::size_t image = 0;  ///< im_id
  struct File {
    std::string modality, folder, extension;
  };
  std::vector<File> files;
};
/// The place of each image of a scene. @param split  name of its folder; readers expect pictures of "train_pbr" also as
/// RGB
std::vector<BopPlace> bop_places(const BopLayout& layout, const std::vector<Sensor>& sensors, const std::string& split);

/// Path of a picture of the scene below its folder.
std::string bop_picture(const BopLayout& layout);

}  // namespace bin_scenes
