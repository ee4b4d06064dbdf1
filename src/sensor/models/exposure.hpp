/// The automatic exposure of grey images: the parts in view determine how bright they are. It changes brightness only,
/// not depth.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "sensor/models/imager.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The exposure is the longest for which the median of the parts' pixels is at most `median_level`, and at most a
/// hundredth of them is brighter than `bright_level`. Levels are 255 * signal^(1 / gray_gamma): highlights of metal are
/// twenty times as bright as its median, which levels that are linear in the signal would leave nearly black.
constexpr double median_level = 120.0, bright_level = 245.0, gray_gamma = 2.2;

/// Returns the grey levels (0 to 255, row-major) of pixels that receive this light, with the imager's noise. If no part
/// is in view, all lit pixels determine the exposure.
/// @param labels  labels of the parts, row-major; 0: no part
/// @param random  random numbers of the noise
std::vector<std::uint8_t> exposed_for_parts(std::vector<float> light, const std::vector<std::uint16_t>& labels,
                                            int width, const Imager& imager, const Random& random);

}  // namespace bin_scenes
