/// Where the images of a scene lie in BOP's layout by scenes (github.com/thodan/bop_toolkit,
/// docs/bop_datasets_format.md, bop_toolkit_lib/dataset_params.py).
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

struct BopLayout {
  enum class Kind {
    classic,    ///< gray/, depth/, scene_gt.json: image n is that of sensor n
    industrial  ///< gray_SENSOR/, depth_SENSOR/, scene_gt_SENSOR.json: image n is view n of every sensor
  };
  Kind kind = Kind::classic;
  bool tif = false;  ///< industrial: images are .tif instead of .png
  /// industrial: by name of a sensor, in order of the request: of rgb, gray and depth.
  std::vector<std::pair<std::string, std::vector<std::string>>> modalities;
  std::string sensor, modality;  ///< industrial: what estimators are evaluated on
};

/// The sensor that a view belongs to: itself, or the one whose `views` it was made from.
const std::string& sensor_of_view(const Sensor& sensor);

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
/// By image of a scene. `split`: name of its folder; readers want pictures of "train_pbr" as RGB, too.
std::vector<BopPlace> bop_places(const BopLayout& layout, const std::vector<Sensor>& sensors, const std::string& split);

/// Path of a picture of the scene below its folder.
std::string bop_picture(const BopLayout& layout);

}  // namespace bin_scenes
