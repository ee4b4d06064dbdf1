/// Settings of output formats in requests and plans, and what a format cannot represent.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// The layout of the images of a BOP scene (output/bop_layout.hpp).
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
/// Why BOP's files cannot hold what a sensor sees, since they describe it by a camera matrix alone; empty: they can.
std::string bop_misfit(const Sensor& sensor);
extern const char* const bop_misfit_remedy;
/// What BOP's files omit of the output of the sensors; empty if they omit nothing.
std::string bop_loss(const std::vector<Sensor>& sensors);

enum class McapProfile {
  ros1,
  ros2
};  ///< the ROS version whose messages an MCAP file contains; ros2: Humble and later
const char* name_of(McapProfile profile);
/// Throws an input Error for an unknown name. @param where  the key or option that contains the name
McapProfile mcap_profile_of(const std::string& name, const std::string& where);

}  // namespace bin_scenes
