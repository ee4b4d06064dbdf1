/// Settings of output formats that requests and plans have in common, and tests of what a format cannot represent. The
/// files themselves are written by output/.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// The layout of the images of a BOP scene. src/bop/layout.hpp derives the paths from it.
struct BopLayout {
  enum class Kind {
    classic,    ///< folders gray/ and depth/ with scene_gt.json; image n belongs to sensor n
    industrial  ///< folders gray_SENSOR/ and depth_SENSOR/ with scene_gt_SENSOR.json; image n is view n of every sensor
  };
  Kind kind = Kind::classic;
  bool tif = false;  ///< industrial: images are .tif files instead of .png files
  /// Industrial: for each sensor, by name and in the order of the request, its modalities: some of "rgb", "gray" and
  /// "depth".
  std::vector<std::pair<std::string, std::vector<std::string>>> modalities;
  std::string sensor, modality;  ///< industrial: the sensor and the modality on which estimators are evaluated
};

/// Returns the name of the sensor to which a view belongs: the sensor itself, or the one whose key `views` it was made
/// from.
const std::string& sensor_of_view(const Sensor& sensor);
/// Returns the reason why BOP files cannot represent the images of a sensor, or "" if they can. BOP describes a sensor
/// by a camera matrix alone.
std::string bop_misfit(const Sensor& sensor);
/// The remedy that accompanies the reason in error messages.
extern const char* const bop_misfit_remedy;
/// Returns which information of the sensors the BOP files omit, or "" if they omit nothing.
std::string bop_loss(const std::vector<Sensor>& sensors);

/// A format in which scenes are written, as far as requests and plans know it (output/output_format.hpp).
struct SceneFormat {
  std::string name;  ///< a value of the option --formats and of the plan's key `outputs`
  enum class Needs {
    scene,   ///< it contains only poses and report
    images,  ///< it contains images of the sensors, if the request has sensors
    sensors  ///< it contains only images of sensors, so that the request must have sensors
  };
  Needs needs = Needs::scene;
  bool gray = false;  ///< whether it shows the grey images of range sensors
};
/// Returns all formats in the order of lists: those of this library, then those that the program has added.
const std::vector<SceneFormat>& scene_formats();
/// Returns the format of that name; null if there is none.
const SceneFormat* find_scene_format(const std::string& name);
void add_scene_format(const SceneFormat& format);
/// Returns a list such as "json, pcd and ply". @param last  "and" or "or"; @param more  names that follow
std::string format_names(const char* last, const std::vector<std::string>& more = {});

enum class McapProfile {
  ros1,
  ros2
};  ///< the ROS version whose messages an MCAP file contains; ros2 means Humble and later
const char* name_of(McapProfile profile);
/// Returns the profile of that name. Throws an input Error for an unknown name. @param where  the key or option that
/// contains the name
McapProfile mcap_profile_of(const std::string& name, const std::string& where);

}  // namespace bin_scenes
