/// Fast PNG writer for masks that are 0 nearly everywhere: a scene of a data set holds hundreds of them.
#pragma once

#include "output/png.hpp"

namespace bin_scenes {

/// A rectangle of an image; what lies outside is 0.
struct MaskBox {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> inside;  ///< row-major, 0 or 1
};
/// 8 bits a pixel, 0 or 255, of the whole image.
Bytes mask_png(int width, int height, const MaskBox& box);

}  // namespace bin_scenes
