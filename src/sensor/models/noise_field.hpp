/// Normally distributed noise over an image with correlated neighbours, like the errors of a window matcher:
/// overlapping windows share the noise of their common pixels. The analytic form of the stereo model adds it to
/// disparities.
#pragma once

#include "bin_scenes/core/random.hpp"

#include <vector>

namespace bin_scenes {

/// @param window  pixels: the autocorrelation is a Gaussian with the standard deviation of that of a box of this width
/// @return        width * height numbers, row-major, mean 0, standard deviation 1
std::vector<float> correlated_noise(int width, int height, double window, const Random& random);

}  // namespace bin_scenes
