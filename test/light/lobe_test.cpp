#include "light/lobe.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

/// What is drawn is as dense as it says: the density integrates to the share of samples above the surface.
TEST(Lobe, SamplesFollowIt) {
  for (const double roughness : {0.15, 0.4, 0.9}) {
    for (const double degrees : {0.0, 45.0, 80.0, 87.0}) {
      const double t = degrees * M_PI / 180.0;
      const Lobe lobe({0.8, 0.9, roughness}, Vec3::UnitZ(), Vec3(std::sin(t), 0.0, std::cos(t)));
      constexpr int side = 300;
      double sent = 0.0;
      for (int i = 0; i < side; ++i) {
        for (int k = 0; k < side; ++k) sent += lobe.at((i + 0.5) / side, (k + 0.5) / side).factor / (side * side);
      }
      EXPECT_NEAR(sent, 0.8, 0.008) << roughness << " " << degrees;
    }
  }
}

TEST(Lobe, SamplesFollowThatOfABrushedSurface) {
  Surface surface{0.8, 0.9, 0.5};
  surface.anisotropy = 0.8;
  surface.along = Vec3(2.0, 1.0, 0.5);  // not in the surface
  const Vec3 normal = Vec3(0.2, -0.1, 1.0).normalized(), x = normal.unitOrthogonal(), y = normal.cross(x);
  for (const double degrees : {0.0, 45.0, 80.0}) {
    for (const double turn : {0.0, 0.7, 1.4}) {
      const double t = degrees * M_PI / 180.0;
      const Vec3 eye = std::sin(t) * (std::cos(turn) * x + std::sin(turn) * y) + std::cos(t) * normal;
      const Lobe lobe(surface, normal, eye);
      constexpr int side = 300;
      double sent = 0.0, beside = 0.0, drawn = 0.0;
      for (int i = 0; i < side; ++i) {
        for (int k = 0; k < side; ++k) {
          const Lobe::Sample sample = lobe.at((i + 0.5) / side, (k + 0.5) / side);
          sent += sample.factor / (side * side);
          if (sample.factor > 0.0) {
            ASSERT_NEAR(lobe.density_of(sample.direction), sample.density, 1e-9 * sample.density);
            beside += (sample.direction.dot(x) > 0.3) / static_cast<double>(side * side);
          }
        }
      }
      EXPECT_NEAR(sent, 0.8, 0.01) << degrees << " " << turn;
      // Directions of one half, by the density's own integral.
      constexpr int rings = 600, sectors = 1200;
      for (int i = 0; i < rings; ++i) {
        const double s = (i + 0.5) / rings * 0.5 * M_PI;
        for (int k = 0; k < sectors; ++k) {
          const double p = (k + 0.5) / sectors * 2.0 * M_PI;
          const Vec3 way = std::sin(s) * (std::cos(p) * x + std::sin(p) * y) + std::cos(s) * normal;
          if (way.dot(x) > 0.3) drawn += lobe.density_of(way) * std::sin(s);
        }
      }
      drawn *= (0.5 * M_PI / rings) * (2.0 * M_PI / sectors);
      EXPECT_NEAR(beside, drawn, 0.004) << degrees << " " << turn;
    }
  }
}

}  // namespace
}  // namespace bin_scenes
