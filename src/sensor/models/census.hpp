/// A stereo matcher for census signatures, like those in the hardware of compact stereo cameras. Two images are
/// compared by bits that state which of two pixels is brighter, so that gain and offset of the cameras do not matter
/// (Zabih, Woodfill 1994, "Non-parametric local transforms for computing visual correspondence"; pairs of opposite
/// pixels: Spangenberg et al. 2013, "Weighted semi-global matching and center-symmetric census transform"). Its tests
/// have the names of the settings that librealsense lists for the cameras D400 (second peak, left-right agreement); the
/// matcher of that device is not published in full.
#pragma once

#include "sensor/models/stereo.hpp"

#include <vector>

namespace bin_scenes {

/// Returns the number of bits of the signature of a window with an odd edge length (pixels).
constexpr int census_bits(int edge) {
  return (edge * edge - 1) / 2;
}
/// Returns the largest odd window (pixels) over which the cost of signatures from windows of `edge` fits into 15 bits.
constexpr int most_census_window(int edge) {
  int window = 1;
  while (census_bits(edge) * (window + 2) * (window + 2) < 32767) window += 2;
  return window;
}

/// Returns the disparities (pixels) of the first image, at least `least_disparity`; NaN means unmatched. The cost of a
/// disparity is the number of bits that differ, summed over a window. The lowest cost wins if none but its two
/// neighbours comes within StereoPipeline::second_peak, and if the pixel of the second image agrees within
/// max_difference. Two lines of equal slope through the cost and its neighbours give fractions of a pixel (equiangular
/// fit: Shimizu, Okutomi 2005, "Sub-pixel estimation error cancellation on area-based matching"). Across a step of less
/// than about two pixels, disparities are blended over the window. At a larger step, two disparities fit about equally
/// well, so that a gap opens along the edge: at least 2 * second_peak windows wide, because at most half of the bits of
/// a wrong disparity differ. Unlike in `match`, pixels without texture and speckles are not removed.
std::vector<float> match_census(const Stereo::Pair& images, int width, int height, const StereoSettings& settings,
                                const StereoPipeline& pipeline, int least_disparity);

}  // namespace bin_scenes
