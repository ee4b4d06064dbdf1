/// Finds the known word that is nearest to a mistyped one, for error messages. Nothing is corrected automatically.
#pragma once

#include <string>
#include <vector>

namespace bin_scenes::config {

/// Least number of letters put in, taken out, replaced or swapped with the next (Damerau 1964, optimal alignment).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Nearest of `known`, or "" if none is near enough to be meant (a third of the letters, at least 2, may differ,
/// but not all of them).
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace bin_scenes::config
