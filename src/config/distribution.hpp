/// Distributions of a plan: values that differ from heap to heap, and how they are drawn. A draw depends on the key of
/// the random stream only, so that each heap can be drawn alone.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "config/key_reader.hpp"

#include <yaml-cpp/yaml.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes::config {

/// What is drawn is text in YAML's flow style, as --set takes it.
struct Distribution {
  enum class Kind {
    constant,  ///< any value
    uniform,   ///< [min, max]; whole numbers if both are written as such
    normal,    ///< [mean, sigma], within min and max if they are given
    choice,    ///< one of several values of any type, with weights
    times,     ///< the request's own number, or each of its numbers, times what is drawn
    jitter,    ///< a pose moved by at most `move` (m) and turned by at most `turn` (rad)
    view       ///< a pose that looks at `target` from `distance` (m), `tilt` (rad) from above, at `turn` (rad) around z
  };
  Kind kind = Kind::constant;
  std::vector<std::string> values;  ///< constant: one; choice: several
  std::vector<double> weights;      ///< choice
  double a = 0.0, b = 0.0;          ///< uniform: bounds; normal: mean and standard deviation
  bool whole = false;
  std::optional<double> min, max;
  std::shared_ptr<Distribution> factor;                      ///< times
  std::shared_ptr<Distribution> distance, tilt, turn, roll;  ///< view
  Pose pose;                                                 ///< jitter
  double move = 0.0, angle = 0.0;                            ///< jitter
  Vec3 target = Vec3::Zero();                                ///< view

  /// @param own  the request's own value, for `times`
  std::string draw(Random& random, const YAML::Node& own) const;
  double number(Random& random) const;  ///< draws a number; only for uniform, normal and constant numbers
  /// Values at the ends of what can be drawn.
  std::vector<std::string> ends(const YAML::Node& own) const;
};

/// Faults go to the source, with their lines; none then.
std::optional<Distribution> read_distribution(const YAML::Node& node, const std::string& path, Source& source);
/// Reads a distribution of numbers only.
std::optional<Distribution> read_number(const YAML::Node& node, const std::string& path, Source& source);

std::string known_distributions();  ///< for advice

std::string flow_text(const YAML::Node& node);

}  // namespace bin_scenes::config
