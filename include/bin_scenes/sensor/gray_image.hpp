/// The grey image of a sensor, as data sets contain it: a level of 0 to 255 for each pixel. Its
/// automatic exposure and its gamma of 2.2 are described in docs/use/sensors.md.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Returns the levels of RangeImage::gray, row-major. If the sensor model makes no such image, they are those of the
/// picture (255 * intensity); without a picture, the intensity is exposed for the parts. They are 0 where the intensity
/// is not finite. Throws an input Error if the model makes a grey image, but `image` was made without it (Draw::gray).
std::vector<std::uint8_t> gray_of(const RangeImage& image);

}  // namespace bin_scenes
