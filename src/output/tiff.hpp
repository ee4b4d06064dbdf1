/// Writes images as TIFF files for BOP. Readers of some data sets expect the grey images, or all images, in this
/// format.
#pragma once

#include "output/png.hpp"
#include "output/png_reader.hpp"

#include <string>

namespace bin_scenes {

/// Returns a TIFF file of one deflated strip, 8 bits per sample. `channels`: 1 = grey, 3 = RGB.
Bytes tiff8(int width, int height, int channels, const std::vector<std::uint8_t>& samples);
/// Returns a TIFF file of a grey image with 16 bits.
Bytes tiff16(int width, int height, const std::vector<std::uint16_t>& samples);
/// Reads a file of tiff8() or tiff16(). Throws an input Error that names the path.
LoadedImage load_tiff(const std::string& path);

}  // namespace bin_scenes
