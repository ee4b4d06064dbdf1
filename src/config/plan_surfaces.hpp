/// The key `surfaces` of a plan: parts of one line get different optical surfaces. Because a line of a request has one
/// surface, such a line is split into several lines.
#pragma once

#include "config/plan_state.hpp"

#include <functional>
#include <vector>

namespace bin_scenes::config {

/// Returns whether a key of the request belongs to the surface of a part line.
bool is_of_surface(const std::string& path);

/// Splits each part line for whose surface a key is drawn into `kinds` lines that differ only in their surface, except
/// for lines that are fixed or have poses. The count of a line, and its share of the amount, are divided evenly.
/// @param drawn  returns the request with surfaces drawn again for this kind; kind 0 is `request` itself
void split_surfaces(Request& request, Amount& amount, const std::vector<Draw>& draws, std::size_t kinds,
                    const std::function<Request(std::size_t kind)>& drawn);

}  // namespace bin_scenes::config
