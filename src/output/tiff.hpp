/// Grey images of BOP's layouts, whose readers want them as TIFF.
#pragma once

#include "output/png.hpp"
#include "output/png_reader.hpp"

#include <string>

namespace bin_scenes {

/// 8-bit grey TIFF of one strip, deflated.
Bytes gray_tiff(int width, int height, const std::vector<std::uint8_t>& samples);
/// A file of gray_tiff(). Throws an input Error that names the path.
LoadedImage load_gray_tiff(const std::string& path);

}  // namespace bin_scenes
