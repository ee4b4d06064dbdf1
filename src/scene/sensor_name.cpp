#include "bin_scenes/scene/sensor_name.hpp"

#include <algorithm>
#include <cctype>

namespace bin_scenes {

std::string graph_name(const std::string& sensor) {
  std::string name = sensor;
  std::replace(name.begin(), name.end(), '-', '_');
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) name = "sensor_" + name;
  return name;
}

}  // namespace bin_scenes
