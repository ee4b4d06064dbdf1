/// Formats counts and lengths for messages about meshes. It is for text that people read only.
#pragma once

#include "core/formatted.hpp"

#include <string>

namespace bin_scenes {

/// Returns a number with three significant digits.
inline std::string number(double x) {
  return formatted("%.3g", x);
}

/// Returns a count with its noun: "1 hole", "2 holes".
inline std::string count(std::size_t n, const char* thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

}  // namespace bin_scenes
