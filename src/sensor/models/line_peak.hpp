/// Finds the position of a laser line in one column of the image with sub-pixel accuracy.
#pragma once

#include <cstddef>
#include <optional>

namespace bin_scenes {

struct LinePeak {
  double row;     ///< from the window's first row
  double height;  ///< the largest signal of the line
};

/// The brightest row of a window, made finer by the parabola through the logarithms of its signal and of those a line's
/// width away: exact for a Gaussian line without noise. None if the brightest row is below `threshold` or at the end.
/// @param sigma  rows, of the line that the device expects
std::optional<LinePeak> find_line(const float* signals, std::size_t count, double sigma, double threshold);

}  // namespace bin_scenes
