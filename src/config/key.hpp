/// One key of a request, as the tables in keys.hpp and sensor_keys.hpp list them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace bin_scenes::config {

struct Key {
  const char* name;
  const char* unit;         ///< "" if it has none
  const char* text;         ///< meaning; what a larger or smaller value costs
  bool written = true;      ///< false: has no meaning for the other values, and is left out when written back
  std::uint64_t least = 0;  ///< of whole numbers: what the check of the request takes
};

/// Names of an enumeration as the request spells them.
template <class Enum>
using Names = std::vector<std::pair<const char*, Enum>>;

}  // namespace bin_scenes::config
