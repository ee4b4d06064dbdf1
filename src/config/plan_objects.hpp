/// The models that the heaps of a plan may contain, each listed once, with the symmetries that the key `bop.symmetries`
/// states for them. Their order gives the object numbers of BOP.
#pragma once

#include "bin_scenes/config/plan.hpp"

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes::config {

struct PlanObjects {
  YAML::Node symmetries;        ///< symmetries that the plan states, with the model as key; may be undefined
  std::vector<PlanObject> all;  ///< in the order in which requests first name them
  std::string digests;          ///< digests of the files of models, bins and lamps

  using Complain = std::function<void(const std::string& problem, const std::string& remedy)>;
  /// Adds the models that a request uses. Calls `complain` for symmetries that are not valid.
  void add(const Request& request, const Complain& complain);
  /// Calls `complain` for symmetries of models that the plan does not use. To be called after all add().
  void check_names(const Complain& complain) const;
};

}  // namespace bin_scenes::config
