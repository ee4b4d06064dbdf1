#include "sensor/models/illumination.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

/// Share of the light from a direction that a surface sends back into the hemisphere.
double sent_back(const Surface& surface, double incidence) {
  constexpr int rings = 700, sectors = 700;
  const Vec3 normal = Vec3::UnitZ(), to_light(std::sin(incidence), 0.0, std::cos(incidence));
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double t = (i + 0.5) / rings * 0.5 * M_PI;
    for (int k = 0; k < sectors; ++k) {
      const double p = (k + 0.5) / sectors * M_PI;  // the other half is the same
      const Vec3 to_eye(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
      sum += reflected(surface, normal, to_light, to_eye) * std::cos(t) * std::sin(t);
    }
  }
  return 2.0 * sum * (0.5 * M_PI / rings) * (M_PI / sectors) / (M_PI * std::cos(incidence));
}

TEST(Illumination, SurfacesSendBackTheirAlbedo) {
  for (const double gloss : {0.0, 0.6, 1.0}) {
    for (const double roughness : {0.2, 0.35, 0.5, 0.7, 0.85, 1.0}) {
      for (const double degrees : {0.0, 30.0, 60.0, 80.0, 86.0}) {
        const double share = sent_back({0.8, gloss, roughness}, degrees * M_PI / 180.0) / 0.8;
        EXPECT_NEAR(share, 1.0, 0.01) << gloss << " " << roughness << " " << degrees;
      }
    }
  }
}

TEST(Illumination, LightMayGoEitherWay) {
  const Surface surface{0.7, 0.8, 0.6};
  const Vec3 a = Vec3(0.8, 0.1, 0.4).normalized(), b = Vec3(-0.3, 0.5, 0.9).normalized(), normal = Vec3::UnitZ();
  EXPECT_NEAR(reflected(surface, normal, a, b) / a.z(), reflected(surface, normal, b, a) / b.z(), 1e-12);
}

}  // namespace
}  // namespace bin_scenes
