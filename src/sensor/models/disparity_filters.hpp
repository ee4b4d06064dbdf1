/// The post-processing of disparities in a stereo camera. Images of disparities are row-major, in pixels; NaN means
/// unmatched.
#pragma once

#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include <cstdint>
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

/// The temporal filter of librealsense: a pixel becomes alpha of itself and 1 - alpha of its last result if both differ
/// by less than delta; otherwise it starts again. A missing pixel takes its last result if it was
/// valid in as many of the previous images as `persistence` demands.
class TemporalAverage {
 public:
  explicit TemporalAverage(const TemporalFilter& settings) : settings_(settings) {}
  /// Replaces the disparities of the next image by the filtered ones.
  void add(std::vector<float>& disparities);

 private:
  bool persists(unsigned history) const;

  TemporalFilter settings_;
  std::vector<float> last_;             ///< results; NaN before the first
  std::vector<std::uint8_t> measured_;  ///< in which of the last eight images; bit 0: the last one
};

/// Standard deviation after the filter of noise that differs in each image, of 1 before it, where no difference reaches
/// delta: the square root of alpha / (2 - alpha) plus what the first image still contributes.
double temporally_filtered_noise(const TemporalFilter& settings);

/// Fills each missing pixel from its neighbours to the left, above and below, row by row, so that filled pixels are
/// used as well. `farthest` takes the smallest of their disparities, `nearest` the largest.
void fill_holes(HoleFilling filling, int width, int height, std::vector<float>& disparities);

/// One value for each square of `factor` pixels: the median of the depths (the smaller of the two in the middle) up to
/// a factor of 3, from 4 on their mean, of those that exist; NaN without any. Incomplete squares are left out.
std::vector<float> decimated(int factor, int width, int height, const std::vector<float>& disparities);

/// The nearest multiple of the step; the disparity itself if the step is 0.
double rounded_to_step(double disparity, double step);

}  // namespace bin_scenes
