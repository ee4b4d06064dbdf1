/// The post-processing of disparities in a stereo camera. Images of disparities are row-major, in pixels; NaN means
/// unmatched.
#pragma once

#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Smooths disparities but keeps steps. Each iteration has four passes: to the right, to the left, down and up. In a
/// pass, a pixel becomes alpha * its value + (1 - alpha) * the result of the previous pixel, if both were valid before
/// the pass and differed by less than delta; otherwise, it keeps its value. Away from borders and larger steps, a pair
/// of opposite passes is a convolution with alpha / (2 - alpha) * (1 - alpha)^|k|, where k is the offset in pixels.
void filter_spatially(const SpatialFilter& settings, int width, int height, std::vector<float>& disparities);

/// Returns the standard deviation of correlated_noise() of this window (pixels) after the spatial filter, if it is 1
/// before the filter and no difference of neighbours reaches delta.
double spatially_filtered_noise(const SpatialFilter& settings, double window);

/// The temporal filter of librealsense: a pixel becomes alpha * its value + (1 - alpha) * its previous result if both
/// differ by less than delta; otherwise, averaging restarts with its value. A missing pixel takes its previous result
/// if it was valid in as many of the previous images as `persistence` requires.
class TemporalAverage {
 public:
  explicit TemporalAverage(const TemporalFilter& settings) : settings_(settings) {}
  /// Replaces the disparities of the next image by the filtered ones.
  void add(std::vector<float>& disparities);

 private:
  bool persists(unsigned history) const;

  TemporalFilter settings_;
  std::vector<float> last_;             ///< results for the latest image; NaN before the first one
  std::vector<std::uint8_t> measured_;  ///< by pixel: the last eight images in which it was valid; bit 0: the latest
};

/// Returns the standard deviation, after the temporal filter, of noise that is independent in each image and is 1
/// before. No difference must reach delta. It is sqrt(alpha / (2 - alpha) + remaining share of the first image).
double temporally_filtered_noise(const TemporalFilter& settings);

/// Fills each missing pixel from its neighbours to the left, above and below, row by row, so that filled pixels are
/// used as well. `farthest` takes the smallest of their disparities, `nearest` the largest.
void fill_holes(HoleFilling filling, int width, int height, std::vector<float>& disparities);

/// Returns one disparity for each square of `factor` x `factor` pixels: for factors up to 3 the (upper) median of the
/// valid ones, else that of their mean depth; NaN if none is valid. Incomplete squares are dropped.
std::vector<float> decimated(int factor, int width, int height, const std::vector<float>& disparities);

/// Returns the multiple of `step` (pixels) that is nearest to the disparity, or the disparity itself if the step is 0.
double rounded_to_step(double disparity, double step);

}  // namespace bin_scenes
