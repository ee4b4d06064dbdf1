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

/// The distribution of one key. Drawn values are text in YAML's flow style, in the form that the option --set accepts.
struct Distribution {
  enum class Kind {
    constant,  ///< always the same value, of any type
    uniform,   ///< uniform in [min, max]; integers if both bounds are written as integers
    normal,    ///< Gaussian [mean, sigma], cut off at min and max if they are given
    choice,    ///< one of several values of any type, with weights
    times,     ///< the value of the request, or each number of its list, multiplied by a drawn factor
    jitter,    ///< a pose moved by at most `move` (m) and turned by at most `turn` (rad)
    view       ///< a pose that looks at `target` from `distance` (m), `tilt` (rad) from above, at `turn` (rad) around z
  };
  Kind kind = Kind::constant;
  std::vector<std::string> values;       ///< constant: one; choice: several
  std::vector<double> weights;           ///< choice
  double a = 0.0, b = 0.0;               ///< for uniform: bounds; for normal: mean and standard deviation
  bool whole = false;                    ///< for uniform: only integers are drawn
  std::optional<double> min, max;        ///< bounds of `normal`
  std::shared_ptr<Distribution> factor;  ///< distribution of the factor of `times`
  std::shared_ptr<Distribution> distance, tilt, turn, roll;  ///< distributions of the camera of `view` (m, rad)
  Pose pose;                                                 ///< pose that `jitter` changes
  double move = 0.0, angle = 0.0;  ///< largest displacement (m) and rotation (rad) of `jitter`
  Vec3 target = Vec3::Zero();      ///< point at which the camera of `view` looks (m)

  /// @param own  value that the request itself has for the key; `times` multiplies it
  std::string draw(Random& random, const YAML::Node& own) const;
  double number(Random& random) const;  ///< draws a number; only for uniform, normal and constant numbers
  /// Returns values at the ends of the distribution, with which a plan is checked before anything is drawn.
  std::vector<std::string> ends(const YAML::Node& own) const;
};

/// Reads a distribution. Errors are reported to `source`, with their lines; the result is then empty.
std::optional<Distribution> read_distribution(const YAML::Node& node, const std::string& path, Source& source);
/// Reads a distribution of numbers only.
std::optional<Distribution> read_number(const YAML::Node& node, const std::string& path, Source& source);

std::string known_distributions();  ///< list of all kinds, for error messages

std::string flow_text(const YAML::Node& node);

}  // namespace bin_scenes::config
