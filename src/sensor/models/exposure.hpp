/// The automatic exposure of grey images: the parts in view determine how bright they are. It changes brightness only,
/// not depth.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "sensor/models/imager.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The median of the parts' pixels has the level `median_level`. Levels up to `knee_level` are 255 *
/// signal^(1 / gray_gamma). A level l of this formula that is higher becomes 255 - c^2 / (l - knee_level + c), where c
/// is 255 - knee_level: highlights of polished metal are 500 times as bright as its median, so that no exposure shows
/// both without a knee.
constexpr double median_level = 120.0, knee_level = 160.0, gray_gamma = 2.2;

/// Returns the grey levels (0 to 255, row-major) of pixels that receive this light, with the imager's noise. Pixels
/// that exceed the full well are read from shorter exposures, each of which takes half the time of the one before. If
/// less than half of the parts' pixels are lit, or no part is in view, all lit pixels determine the exposure.
/// @param labels  labels of the parts, row-major; 0: no part
/// @param random  random numbers of the noise
std::vector<std::uint8_t> exposed_for_parts(std::vector<float> light, const std::vector<std::uint16_t>& labels,
                                            int width, const Imager& imager, const Random& random);

}  // namespace bin_scenes
