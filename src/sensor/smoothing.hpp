/// Smooths measured depth and keeps its edges (SmoothingFilter in sensor/filter.hpp).
#pragma once

#include "bin_scenes/sensor/filter.hpp"

namespace bin_scenes {

void smooth(const SmoothingFilter& settings, RangeImage& image);

}  // namespace bin_scenes
