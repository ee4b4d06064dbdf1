/// Run lengths of masks against a plain walk over the pixels, for boxes at every place of a small image.
#include "bop/masks.hpp"

#include <gtest/gtest.h>

#include <random>

namespace bin_scenes {
namespace {

std::vector<std::size_t> plain(const MaskBox& mask, int width, int height) {
  std::vector<std::size_t> counts{0};
  bool value = false;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) {
      const int column = x - mask.left, row = y - mask.top;
      const bool in_box = column >= 0 && row >= 0 && column < mask.width && row < mask.height;
      const bool inside = in_box && mask.inside[static_cast<std::size_t>(row * mask.width + column)] != 0;
      if (inside != value) counts.push_back(0), value = inside;
      ++counts.back();
    }
  }
  return counts;
}

TEST(RunLengths, AreThoseOfAWalkOverAllPixels) {
  std::mt19937 dice(1);
  const int width = 5, height = 4;
  for (int left = 0; left < width; ++left) {
    for (int top = 0; top < height; ++top) {
      for (int trial = 0; trial < 40; ++trial) {
        MaskBox mask{left,
                     top,
                     1 + static_cast<int>(dice() % static_cast<unsigned>(width - left)),
                     1 + static_cast<int>(dice() % static_cast<unsigned>(height - top)),
                     {}};
        for (int i = 0; i < mask.width * mask.height; ++i) mask.inside.push_back(trial % 4 == 0 || dice() % 3 != 0);
        EXPECT_EQ(run_lengths(mask, width, height), plain(mask, width, height));
      }
    }
  }
  EXPECT_EQ(run_lengths({}, width, height), (std::vector<std::size_t>{20}));
}

}  // namespace
}  // namespace bin_scenes
