/// Smoothing of measured depth that keeps its edges.
#pragma once

#include "bin_scenes/sensor/filter.hpp"

namespace bin_scenes {

void smooth(const SmoothingFilter& settings, RangeImage& image);

}  // namespace bin_scenes
