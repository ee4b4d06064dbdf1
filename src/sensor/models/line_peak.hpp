/// Finds the position of a laser line in one column of the image with sub-pixel accuracy. The decoded form of the laser
/// line sensor uses it; the error of the analytic form follows from the same estimator.
#pragma once

#include <cstddef>
#include <optional>

namespace bin_scenes {

struct LinePeak {
  double row;     ///< position of the peak, in rows from the first row of the window
  double height;  ///< signal of the brightest row
};

/// Finds the brightest row of a window with sub-pixel accuracy, by the parabola through the logarithms of its signal
/// and of the signals a line's width away; it is exact for a Gaussian line without noise. Returns none if the brightest
/// row is below `threshold` or at an end of the window.
/// @param sigma  standard deviation of the line's profile that the device expects (rows)
std::optional<LinePeak> find_line(const float* signals, std::size_t count, double sigma, double threshold);

}  // namespace bin_scenes
