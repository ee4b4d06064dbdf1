/// Smooths measured depth and keeps its edges (SmoothingFilter in sensor/filter.hpp). It is the filter that drivers of
/// cameras call edge-preserving; pixels without depth stay empty.
#pragma once

#include "bin_scenes/sensor/filter.hpp"

namespace bin_scenes {

void smooth(const SmoothingFilter& settings, RangeImage& image);

}  // namespace bin_scenes
