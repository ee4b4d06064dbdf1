/// The number of pixels of one part in an image, and the box around them.
#pragma once

#include "output/boxes.hpp"

namespace bin_scenes {

struct Extent : PixelBox {
  std::size_t count = 0;
  void add(int x, int y) {
    ++count;
    extend(x, y);
  }
};

}  // namespace bin_scenes
