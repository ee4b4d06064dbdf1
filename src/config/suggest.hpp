/// Finds the known word that is nearest to a mistyped one, for error messages. Nothing is corrected automatically.
#pragma once

#include <string>
#include <vector>

namespace bin_scenes::config {

/// Returns the least number of letters to insert, delete, replace or swap with the next one (Damerau 1964).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Returns the nearest word of `known`, or "" if none is near enough. A word is near enough if at most a third of its
/// letters differ (but always 2 may differ), and not all of them.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace bin_scenes::config
