/// The post-processing of disparities in a stereo camera. Images of disparities are row-major, in pixels; NaN means
/// unmatched. No filter fills holes.
#pragma once

#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include <vector>

namespace bin_scenes {

/// One iteration passes to the right, to the left, down and up. In a pass a pixel becomes alpha of itself and
/// 1 - alpha of the result of the pixel before it, if both had values before the pass and these differ by less than
/// delta; otherwise it stays. Far from borders and larger steps, passes in both directions are a convolution with
/// alpha / (2 - alpha) * (1 - alpha)^|k|.
void filter_spatially(const SpatialFilter& settings, int width, int height, std::vector<float>& disparities);

/// Standard deviation that correlated_noise() of this window has after the filter, of 1 before it, where no difference
/// reaches delta.
double spatially_filtered_noise(const SpatialFilter& settings, double window);

/// The nearest multiple of the step; the disparity itself if the step is 0.
double rounded_to_step(double disparity, double step);

}  // namespace bin_scenes
