#include "bin_scenes/raster/lens.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

TEST(Lens, ProjectsAndLooksBack) {
  Lens lens = Lens::from_fov(1280, 1024, 0.8);
  lens.skew = 1.5;
  for (const auto& distortion :
       {std::array<double, 5>{}, {-0.28, 0.09, 1e-3, -5e-4, -0.01}, {0.1, -0.05, 0, 0, 0.02}}) {
    lens.distortion = distortion;
    for (double row = 0; row < 1024; row += 93) {
      for (double column = 0; column < 1280; column += 71) {
        const Vec3 ray = lens.ray(column, row);
        ASSERT_EQ(ray.z(), 1.0);
        const auto pixel = lens.project(1.7 * ray);
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x(), column, 1e-9);
        EXPECT_NEAR(pixel->y(), row, 1e-9);
      }
    }
  }
}

TEST(Lens, DistortsAsPlumbBobSays) {
  Lens lens;
  lens.width = lens.height = 100;
  lens.fx = lens.fy = 1.0;  // pixels are distorted coordinates
  lens.distortion = {0.1, 0.02, 0.003, 0.004, 0.005};
  const double x = 0.3, y = -0.2, r2 = x * x + y * y;
  const double radial = 1 + 0.1 * r2 + 0.02 * r2 * r2 + 0.005 * r2 * r2 * r2;
  const auto pixel = lens.project({0.6, -0.4, 2.0});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), x * radial + 2 * 0.003 * x * y + 0.004 * (r2 + 2 * x * x), 1e-15);
  EXPECT_NEAR(pixel->y(), y * radial + 0.003 * (r2 + 2 * y * y) + 2 * 0.004 * x * y, 1e-15);
}

TEST(Lens, EndsWhereItsDistortionFoldsBack) {
  Lens lens = Lens::from_fov(100, 100, 2.0);
  lens.distortion = {-0.5, 0, 0, 0, 0};  // r (1 - r2 / 2) is largest, 0.54, at r = 0.82
  EXPECT_TRUE(lens.project({0.8, 0, 1}));
  EXPECT_FALSE(lens.project({0.9, 0, 1}));
  EXPECT_FALSE(lens.project({0, 0, -1}));
  EXPECT_TRUE(lens.ray(lens.cx + 0.54 * lens.fx, lens.cy).allFinite());
  EXPECT_FALSE(lens.ray(lens.cx + 0.6 * lens.fx, lens.cy).allFinite());
}

}  // namespace
}  // namespace bin_scenes
