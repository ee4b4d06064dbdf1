/// One key of a request or of scene.json, as the tables of keys list them (docs/develop/architecture.md, One table for
/// each struct): readers, writers, range checks, messages, the JSON schema and the generated pages all use this entry.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// The allowed values of a number, or of each number of a list or vector.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;  ///< least itself is excluded
};
constexpr Range anything{};
constexpr Range at_least(double least, double most = std::numeric_limits<double>::infinity()) {
  return {least, most, false};
}
constexpr Range above(double least, double most = std::numeric_limits<double>::infinity()) {
  return {least, most, true};
}

struct Key {
  const char* name;
  const char* unit;  ///< "" if it has none
  const char* text;  ///< meaning; what a larger or smaller value costs
  Range range = anything;
  bool written =
      true;  ///< false: without meaning for the present values of other keys; then neither written back nor checked
  bool needed = false;  ///< a file without it is refused
};

/// Names of an enumeration as the request spells them.
template <class Enum>
using Names = std::vector<std::pair<const char*, Enum>>;

/// The name of a value, by the table names(Enum) of its enumeration.
template <class Enum>
const char* name_in_table(Enum value) {
  for (const auto& [name, meaning] : names(value))
    if (meaning == value) return name;
  return "?";
}

/// A value that is one of the words known.
struct Word {
  std::string value;
  std::vector<std::string> known;
};

}  // namespace bin_scenes
