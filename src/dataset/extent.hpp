/// Pixels of one part, counted, and the box round them.
#pragma once

#include <algorithm>
#include <cstddef>

namespace bin_scenes {

struct Extent {
  std::size_t count = 0;
  int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1;  ///< of the outermost pixels
  void add(int x, int y) {
    ++count;
    left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
  }
};

}  // namespace bin_scenes
