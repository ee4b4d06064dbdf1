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
  YAML::Node symmetries;        ///< symmetries that the plan states, by model; may be undefined
  std::vector<PlanObject> all;  ///< in order of their first appearance
  std::string digests;          ///< digests of the model files, and of the files of bins and lamps

  using Complain = std::function<void(const std::string& problem, const std::string& remedy)>;
  /// Notes what a request names. Symmetries that are none are complained of.
  void add(const Request& request, const Complain& complain);
  /// Complains of symmetries of what is no model of the plan, once all are noted.
  void check_names(const Complain& complain) const;
};

}  // namespace bin_scenes::config
