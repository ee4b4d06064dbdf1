#include "light/illumination.hpp"
#include "light/facets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

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
        EXPECT_NEAR(share, 1.0, 0.007) << gloss << " " << roughness << " " << degrees;
      }
    }
  }
}

TEST(Illumination, LightMayGoEitherWay) {
  const Surface surface{0.7, 0.8, 0.6};
  const Vec3 a = Vec3(0.8, 0.1, 0.4).normalized(), b = Vec3(-0.3, 0.5, 0.9).normalized(), normal = Vec3::UnitZ();
  EXPECT_NEAR(reflected(surface, normal, a, b) / a.z(), reflected(surface, normal, b, a) / b.z(), 1e-12);
}

/// The same of a brushed surface, whose lines lie at an angle to the plane of incidence.
double brushed(const Surface& surface, double incidence, double turn) {
  constexpr int rings = 300, sectors = 400;
  const Vec3 normal = Vec3::UnitZ();
  const Vec3 to_light(std::sin(incidence) * std::cos(turn), std::sin(incidence) * std::sin(turn), std::cos(incidence));
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double t = (i + 0.5) / rings * 0.5 * M_PI;
    for (int k = 0; k < sectors; ++k) {
      const double p = (k + 0.5) / sectors * 2.0 * M_PI;
      const Vec3 to_eye(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
      sum += reflected(surface, normal, to_light, to_eye) * std::cos(t) * std::sin(t);
    }
  }
  return sum * (0.5 * M_PI / rings) * (2.0 * M_PI / sectors) / (M_PI * std::cos(incidence));
}

Surface with_lines(double gloss, double roughness, double anisotropy) {
  Surface surface{0.8, gloss, roughness};
  surface.anisotropy = anisotropy;
  surface.along = Vec3::UnitX();
  return surface;
}

TEST(Illumination, BrushedSurfacesSendBackTheirAlbedo) {
  for (const double roughness : {0.35, 0.45, 0.6, 0.85}) {
    for (const double anisotropy : {0.25, 0.6, 0.9}) {
      for (const double degrees : {5.0, 40.0, 75.0}) {
        for (const double turn : {0.0, 0.5, 1.2, 0.5 * M_PI}) {
          const double share = brushed(with_lines(1.0, roughness, anisotropy), degrees * M_PI / 180.0, turn) / 0.8;
          EXPECT_NEAR(share, 1.0, 0.01) << roughness << " " << anisotropy << " " << degrees << " " << turn;
        }
      }
    }
  }
}

TEST(Illumination, LightMayGoEitherWayOverBrushedSurfaces) {
  const Vec3 a = Vec3(0.8, 0.1, 0.4).normalized(), b = Vec3(-0.3, 0.5, 0.9).normalized(), normal = Vec3::UnitZ();
  Surface brass = with_lines(0.8, 0.6, 0.7);
  for (const double refraction : {0.0, 0.444}) {
    brass.refraction = refraction, brass.extinction = 8.3 * refraction;
    EXPECT_NEAR(reflected(brass, normal, a, b) / a.z(), reflected(brass, normal, b, a) / b.z(), 1e-12);
  }
}

/// Facets that face half way between light and eye: GGX's density at the slope, over the widths along and across.
TEST(Illumination, LinesNarrowTheLobeAlongThemAndWidenItAcross) {
  const Surface surface = with_lines(1.0, 0.5, 0.8), even{0.8, 1.0, 0.5};
  const double alpha = 0.25, aspect = std::sqrt(1.0 - 0.9 * 0.8), small = 0.05;
  const auto seen = [&](const Surface& s, const Vec3& way) { return reflected(s, Vec3::UnitZ(), Vec3::UnitZ(), way); };
  const auto density = [&](double slope_x, double slope_y, double along, double across) {
    const double bend = 1.0 + std::pow(slope_x / along, 2) + std::pow(slope_y / across, 2);
    return 1.0 / (along * across * bend * bend);
  };
  const Vec3 x(std::sin(2 * small), 0.0, std::cos(2 * small)), y(0.0, std::sin(2 * small), std::cos(2 * small));
  const double slope = std::tan(small), along = alpha * aspect, across = alpha / aspect;
  // All else (shadowing, what several facets send) changes by little between these two directions.
  EXPECT_NEAR(seen(surface, x) / seen(surface, y),
              density(slope, 0.0, along, across) / density(0.0, slope, along, across), 0.01);
  EXPECT_EQ(seen(with_lines(1.0, 0.5, 0.0), x), seen(even, x)) << "no lines, nothing new";
  Surface unknown = surface;
  unknown.along = Vec3::Zero();
  EXPECT_EQ(seen(unknown, x), seen(even, x));
  unknown.along = Vec3::UnitZ();
  EXPECT_EQ(seen(unknown, x), seen(even, x)) << "lines that end there have no direction";
}

/// Fresnel's amplitudes in complex numbers.
double mirrored(double cosine, std::complex<double> index) {
  const std::complex<double> inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const double across = std::norm((cosine - index * inside) / (cosine + index * inside)),
               along = std::norm((index * cosine - inside) / (index * cosine + inside));
  return 0.5 * (across + along);
}

TEST(Illumination, MetalsMirrorAsFresnelSays) {
  for (const std::complex<double> index : {std::complex<double>(2.9114, 3.0893), {1.3456, 7.4746}, {0.444, 3.695}}) {
    const double n = index.real(), k = index.imag();
    EXPECT_NEAR(fresnel(1.0, n, k), ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-12);
    EXPECT_NEAR(fresnel(0.0, n, k), 1.0, 1e-12);
    double mean = 0.0;
    for (int i = 0; i < 10000; ++i) {
      const double c = (i + 0.5) / 10000;
      ASSERT_NEAR(fresnel(c, n, k), mirrored(c, index), 1e-12) << c;
      mean += mirrored(c, index) * 2.0 * c / 10000;
    }
    EXPECT_NEAR(mean_fresnel(n, k), mean, 1e-4);
  }
  // Glass at Brewster's angle mirrors one polarisation only.
  const double c = 1.0 / std::sqrt(1.0 + 1.5 * 1.5), across = (1.0 - 1.5 * 1.5) / (1.0 + 1.5 * 1.5);
  EXPECT_NEAR(fresnel(c, 1.5, 0.0), 0.5 * across * across, 1e-12);
}

TEST(Illumination, MetalsSendBackNoMoreThanTheyGet) {
  for (const double roughness : {0.2, 0.35, 0.5, 0.7, 1.0}) {
    for (const double degrees : {0.0, 60.0, 86.0}) {
      const double t = degrees * M_PI / 180.0, share = sent_back({1.0, 1.0, roughness, 2.9114, 3.0893}, t);
      EXPECT_LE(share, 1.0) << roughness << " " << degrees;
      if (roughness < 0.3 && degrees < 80.0) {
        EXPECT_NEAR(share, fresnel(std::cos(t), 2.9114, 3.0893), 0.01);
      }
      EXPECT_GT(share, 0.25) << roughness << " " << degrees;
    }
  }
  const Surface brass{0.9, 0.8, 0.6, 0.444, 3.695};
  const Vec3 a = Vec3(0.8, 0.1, 0.4).normalized(), b = Vec3(-0.3, 0.5, 0.9).normalized(), normal = Vec3::UnitZ();
  EXPECT_NEAR(reflected(brass, normal, a, b) / a.z(), reflected(brass, normal, b, a) / b.z(), 1e-12);
}

}  // namespace
}  // namespace bin_scenes
