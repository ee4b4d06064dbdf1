/// The key `surfaces` of a plan: parts of one line get different optical surfaces. Because a line of a request has one
/// surface, such a line is split into several lines.
#pragma once

#include "config/plan_state.hpp"

#include <functional>
#include <vector>

namespace bin_scenes::config {

/// Whether a key of the request belongs to the surface of a part line.
bool is_of_surface(const std::string& path);

/// Splits every part line that draws a key of its surface, and is not fixed, into `kinds` lines that differ in these
/// keys alone. Counts are divided evenly; of the amount, so are the shares, which set_counts() then draws from.
/// @param drawn  the request with the draws of a kind made anew; kind 0 is `request` itself
void split_surfaces(Request& request, Amount& amount, const std::vector<Draw>& draws, std::size_t kinds,
                    const std::function<Request(std::size_t kind)>& drawn);

}  // namespace bin_scenes::config
