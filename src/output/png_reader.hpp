/// Reads PNG files as the arrays of counts from which png.hpp wrote them. Checks of data sets and the audit use it;
/// libpng decodes the files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

struct LoadedImage {
  int width = 0, height = 0, channels = 1, bits = 8;
  std::vector<std::uint16_t> samples;  ///< row-major, the channels of a pixel are adjacent
};

/// Reads grey and RGB images of 8 or 16 bits, and palette images as RGB. Throws an input Error that names the path.
LoadedImage load_png(const std::string& path);
/// Decodes the bytes of a file; `where` names the file in error messages.
LoadedImage png_from(const std::string& bytes, const std::string& where);

}  // namespace bin_scenes
