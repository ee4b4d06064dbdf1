#include "topics.hpp"

#include <algorithm>
#include <cctype>

namespace bin_scenes {

std::string topic::of_sensor(const char* name, std::size_t index, const std::string& sensor) {
  if (index == 0) return name;
  // A graph resource name begins with a letter and has no hyphen; a sensor's name may.
  std::string space = sensor;
  std::replace(space.begin(), space.end(), '-', '_');
  if (space.empty() || !std::isalpha(static_cast<unsigned char>(space[0]))) space = "sensor_" + space;
  return space + "/" + name;
}

SceneMessages scene_messages(const Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
                             const PartModelPtr& bin_model, const Frames& frames, const ros::Time& stamp) {
  return {scene_message(scene, request, frames, stamp), scene_markers(scene, request, parts, bin_model, frames, stamp),
          part_transforms(scene, frames, stamp), static_transforms(scene, frames, stamp)};
}

}  // namespace bin_scenes
