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
  std::optional<double> tolerance;  ///< depth tolerance (m) of visible pixels; used if `measured`
  bool measured = false;            ///< whether measured depth decides which pixels are visible
  bool run_lengths = false;         ///< whether masks are stored as run lengths instead of PNG files
  std::size_t most_targets = 0;     ///< images with more visible parts are no targets; 0: no limit
};

/// @param own      value of the key `bop` of the plan; may be undefined
/// @param sensors  sensors of the request; empty: they are not known, and names of sensors are not checked
/// @param rig      values that the rig of the request states, for keys that the plan lacks; may be undefined
/// @param complain  is called for each error, with the problem, the key below `bop`, and a remedy
BopPlan read_bop_plan(
    const YAML::Node& own, const YAML::Node& rig, const std::vector<Sensor>& sensors,
    const std::function<void(const std::string& problem, const std::string& key, const std::string& remedy)>& complain);

}  // namespace bin_scenes::config
