/// One key of a request or of scene.json, as the tables of keys list them (docs/develop/architecture.md, "One table for
/// each struct"). Readers, writers, range checks, ROS messages, the JSON schema and the generated pages all use this
/// entry, so that a key is described in one place only.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// The allowed values of a number, or of each number of a list or vector: at least `least`, at most `most`.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;  ///< the value `least` itself is not allowed
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
  const char* unit;  ///< "" for a key without a unit
  const char* text;  ///< the meaning and the effect of the value, in full sentences or noun phrases with a full stop
  Range range = anything;
  bool written = true;  ///< false: the present values of other keys make this key meaningless, and it is neither
                        ///< written nor checked
  bool needed = false;  ///< a file without this key is refused
};

/// Returns the text of a key with its unit, for example "Unit: kg. Mass of one part."
inline std::string described(const Key& key) {
  return *key.unit ? "Unit: " + std::string(key.unit) + ". " + key.text : key.text;
}

/// The values of an enumeration with their names in request files.
template <class Enum>
using Names = std::vector<std::pair<const char*, Enum>>;

/// Returns the name of a value according to the table names(Enum) of its enumeration.
template <class Enum>
const char* name_in_table(Enum value) {
  for (const auto& [name, meaning] : names(value))
    if (meaning == value) return name;
  return "?";
}

/// A text value together with the words that are allowed for it.
struct Word {
  std::string value;
  std::vector<std::string> known;
};

}  // namespace bin_scenes
