/// Reads the key `bop` of a plan: which BOP files the data set contains, and in which layout. Its symmetries are read
/// with the models (plan_objects.hpp); the files are written by src/dataset.
#pragma once

#include "bin_scenes/config/formats.hpp"

#include <yaml-cpp/yaml.h>

#include <functional>
#include <optional>
#include <string>

namespace bin_scenes::config {

struct BopPlan {
  BopLayout layout;
  std::optional<double> tolerance;  ///< m, of visible: measured
  bool measured = false;
  bool run_lengths = false;      ///< masks as run lengths instead of PNG files
  std::size_t most_targets = 0;  ///< visible parts of an image that is a target; 0: any number
};

/// @param own   the plan's key; may be undefined
/// @param sensors  of the request; none: not known, names are not checked
/// @param rig   defaults that the request's rig states for keys that the plan lacks; may be undefined
/// @param complain  takes problem, key below "bop" and remedy
BopPlan read_bop_plan(
    const YAML::Node& own, const YAML::Node& rig, const std::vector<Sensor>& sensors,
    const std::function<void(const std::string& problem, const std::string& key, const std::string& remedy)>& complain);

}  // namespace bin_scenes::config
