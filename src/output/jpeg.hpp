/// Writes grey images as JPEG files with three equal channels, because training programs look for colour images in this
/// format. It serves data sets only; measured values are stored without loss in PNG files.
#pragma once

#include "output/png.hpp"

namespace bin_scenes {

/// Returns a JPEG file with three equal channels, at quality 95, whose errors are about one grey level.
Bytes rgb_jpeg(int width, int height, const std::vector<std::uint8_t>& samples);

}  // namespace bin_scenes
