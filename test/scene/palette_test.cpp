#include "scene/palette.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes {
namespace {

/// Hue (0 to 1) of a colour, as in HSV.
double hue_of(const Vec3& c) {
  const double most = c.maxCoeff(), range = most - c.minCoeff();
  const double sixths = most == c.x()   ? (c.y() - c.z()) / range
                        : most == c.y() ? 2.0 + (c.z() - c.x()) / range
                                        : 4.0 + (c.x() - c.y()) / range;
  return std::fmod(sixths / 6.0 + 1.0, 1.0);
}

double apart(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 1.0 - d);
}

/// Hues are a golden angle apart; saturation and value are those of the header.
TEST(Palette, ColoursOfPartsAreAsStated) {
  for (int id = 0; id < 1000; ++id) {
    const Vec3 colour = part_colour(id);
    ASSERT_NEAR(apart(hue_of(colour), std::fmod(0.08 + 0.6180339887498949 * id, 1.0)), 0.0, 1e-9) << id;
    ASSERT_GT(apart(hue_of(colour), hue_of(part_colour(id + 1))), 0.38) << id;
    ASSERT_NEAR(colour.maxCoeff(), 0.97 - 0.07 * (id / 3 % 3), 1e-12);
    ASSERT_NEAR(1.0 - colour.minCoeff() / colour.maxCoeff(), 0.42 + 0.09 * (id % 3), 1e-12);
  }
}

/// The table is never taken for a part.
TEST(Palette, TheTableIsPalerThanAllParts) {
  EXPECT_LT(1.0 - table_colour.minCoeff() / table_colour.maxCoeff(), 0.25);
}

}  // namespace
}  // namespace bin_scenes
