/// The parsed parts of a plan file that are needed to draw requests. The public header (config/plan.hpp) hides this
/// struct so that it does not depend on yaml-cpp.
#pragma once

#include "bin_scenes/config/plan.hpp"
#include "config/distribution.hpp"

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

namespace config {

struct Draw {
  std::string path, where;  ///< key of the request, and its line in the plan for error messages
  Distribution distribution;
};

/// The total number of parts, and how it is divided among the part lines.
struct Amount {
  std::optional<Distribution> parts;  ///< number of parts
  std::optional<Distribution> fill;   ///< volume of all parts, divided by the inner volume of the bin
  std::vector<double> shares;         ///< share of each part line in the number of parts
};

/// Returns the value that the request itself has at a path; undefined if it has none.
YAML::Node own_value(const YAML::Node& root, const std::string& path);

}  // namespace config

struct Plan::State {
  YAML::Node request;
  std::string file, base;  ///< path of the request for error messages, and the folder to which its paths are relative
  std::vector<config::Draw> draws;
  config::Amount amount;
  std::size_t surfaces = 1;  ///< into how many surfaces a part line is divided if its surface is drawn
  std::optional<config::Distribution> take;
};

}  // namespace bin_scenes
