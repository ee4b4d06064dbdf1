/// Writes PNG files of masks quickly. A scene of a data set contains hundreds of masks, which are 0 almost everywhere.
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
