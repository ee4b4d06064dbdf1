/// Grey images as the JPEG files in which trainers look for colour images.
#pragma once

#include "output/png.hpp"

namespace bin_scenes {

/// RGB of three equal channels, at a quality (95) that errs by about one grey level.
Bytes rgb_jpeg(int width, int height, const std::vector<std::uint8_t>& samples);

}  // namespace bin_scenes
