#include "sensor/models/structured_light.hpp"
#include "sensor/fit.hpp"
#include "sensor/shot.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace bin_scenes {
namespace {

/// A camera at the origin of the world that looks along z, and a projector at a baseline on its right, toed in.
struct Device {
  Lens camera = Lens::from_fov(200, 150, 0.35);
  StructuredLight::Setup setup;

  explicit Device(double baseline = 0.2, double distance = 1.0) {
    setup.projector = Lens::from_fov(1280, 800, 0.6);
    setup.projector_pose = {Vec3(baseline, 0.0, 0.0),
                            Quat(Eigen::AngleAxisd(-std::atan(baseline / distance), Vec3::UnitY()))};
    setup.near = 0.05;
    setup.far = 10.0;
  }
};

/// A large plate whose front face passes (0, 0, z), turned about x: the incidence of light and of sight alike.
Targets plate(double z, double tilt = 0.0, const Surface& surface = {}) {
  Targets targets;
  const Quat turn(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
  targets.add(box_target({8.0, 8.0, 0.02}), {Vec3(0, 0, z) + turn * Vec3(0, 0, 0.01), turn}, surface);
  return targets;
}

using test::Shot;
Shot shoot(Targets& targets, const Device& device, bool decoded, std::uint64_t seed = 1) {
  return test::shoot<StructuredLight>(targets, device.camera, device.setup, decoded, seed);
}

std::vector<double> errors(const Shot& shot) {
  std::vector<double> all;
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
    if (shot.measured.validity[i] == Validity::valid)
      all.push_back(std::abs(shot.measured.depth[i] - shot.view.depth[i]));
  }
  std::sort(all.begin(), all.end());
  return all;
}

double share(const Shot& shot, Validity code) {
  const auto& v = shot.measured.validity;
  return static_cast<double>(std::count(v.begin(), v.end(), code)) / static_cast<double>(v.size());
}

/// Root of the mean square of error / predicted sigma, over valid pixels of several shots; their number in `count`.
double over_predicted(Targets& targets, const Device& device, bool decoded, std::size_t wanted, std::size_t& count) {
  double sum = 0.0;
  count = 0;
  for (std::uint64_t seed = 0; count < wanted && seed < 20; ++seed) {
    const Shot shot = shoot(targets, device, decoded, seed);
    for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
      if (shot.measured.validity[i] != Validity::valid) continue;
      const double e = (shot.measured.depth[i] - shot.view.depth[i]) / shot.sigma[i];
      sum += e * e;
      ++count;
    }
  }
  return std::sqrt(sum / static_cast<double>(count));
}

TEST(StructuredLight, DecodedWithoutNoiseFindsAPlane) {
  Device device;
  device.setup.noise = false;
  for (const double tilt : {0.0, 0.6}) {
    Targets targets = plate(1.0, tilt);
    const std::vector<double> e = errors(shoot(targets, device, true));
    ASSERT_GT(e.size(), 29000u);
    EXPECT_LT(e[e.size() / 2], 2e-5) << tilt;
    EXPECT_LT(e[e.size() * 99 / 100], 1e-4) << tilt;
  }
}

TEST(StructuredLight, DistortedLensesTriangulateAsWell) {
  Device device;
  device.setup.noise = false;
  device.camera.distortion = {-0.1, 0.02, 0.001, -0.001, 0.0};
  device.setup.projector.distortion = {0.05, -0.03, -0.001, 0.002, 0.0};
  Targets targets = plate(1.0, 0.3);
  const std::vector<double> e = errors(shoot(targets, device, true));
  ASSERT_GT(e.size(), 29000u);
  EXPECT_LT(e[e.size() / 2], 2e-5);
  EXPECT_LT(e[e.size() * 99 / 100], 1e-4);
  const std::vector<double> exact = errors(shoot(targets, device, false));
  EXPECT_LT(exact.back(), 1e-9);
}

TEST(StructuredLight, NoiseIsAsPredicted) {
  std::size_t count;
  for (const double z : {0.5, 1.0, 2.0}) {
    for (const double degrees : {0.0, 70.0}) {
      for (const double albedo : {0.05, 0.9}) {
        Targets targets = plate(z, degrees * M_PI / 180.0, {albedo, 0.0, 0.4});
        const double ratio = over_predicted(targets, Device(0.2, z), false, 100000, count);
        ASSERT_GE(count, 100000u);
        EXPECT_NEAR(ratio, 1.0, 0.03) << z << " m " << degrees << " deg " << albedo;
      }
    }
  }
}

TEST(StructuredLight, DecodedNoiseIsAsPredicted) {
  std::size_t count;
  for (const double degrees : {0.0, 70.0}) {
    for (const double albedo : {0.05, 0.9}) {
      Targets targets = plate(1.0, degrees * M_PI / 180.0, {albedo, 0.0, 0.4});
      const double ratio = over_predicted(targets, Device(), true, 100000, count);
      ASSERT_GE(count, 100000u);
      EXPECT_NEAR(ratio, 1.0, 0.03) << degrees << " deg " << albedo;
    }
  }
}

TEST(StructuredLight, BlurWeakensTheFringeAsPredicted) {
  Targets targets = plate(1.0, 0.4);
  Device sharp, blurred;
  blurred.setup.imager.blur = 0.6;
  std::size_t count;
  EXPECT_NEAR(over_predicted(targets, blurred, true, 100000, count), 1.0, 0.03);
  // A pixel covers 3.7 columns of a period of 16: its fringe is weaker by exp(-2 (pi 0.6 3.7 / 16)^2) = 0.69.
  const Scenery scenery = targets.scenery();
  const View view = render(scenery, sharp.camera, Pose(), 0.05, 10.0);
  const std::size_t middle = 75 * 200 + 100;
  const StructuredLight a(scenery, view, targets.surfaces(), sharp.setup),
      b(scenery, view, targets.surfaces(), blurred.setup);
  const Pose back = sharp.setup.projector_pose.inverse();
  const auto column = [&](double x) {
    const Vec3 ray = sharp.camera.ray(x, 75.0);
    return sharp.setup.projector.project(back * (view.depth[middle] * ray))->x();
  };
  const double columns = column(100.5) - column(99.5);
  const double weaker = std::exp(-2.0 * std::pow(M_PI * 0.6 * columns / 16.0, 2));
  EXPECT_NEAR(a.depth_sigma(middle) / b.depth_sigma(middle), weaker, 0.005);
}

double mean_sigma(const Device& device, double z) {
  Targets targets = plate(z);
  const Shot shot = shoot(targets, device, false);
  double sum = 0.0;
  for (const double s : shot.sigma) sum += s;
  return sum / static_cast<double>(shot.sigma.size());
}

TEST(StructuredLight, SigmaGrowsWithTheSquareOfRange) {
  // Axes parallel and the plate in both fields; the exposure follows the range.
  Device device;
  device.setup.projector_pose.orientation = Quat::Identity();
  device.setup.projector = Lens::from_fov(1280, 800, 1.2);
  const double near = mean_sigma(device, 0.5), middle = mean_sigma(device, 1.0), far = mean_sigma(device, 2.0);
  EXPECT_NEAR(std::log2(far / middle), 2.0, 0.02);
  EXPECT_NEAR(0.5 * std::log2(far / near), 2.0, 0.02);
}

TEST(StructuredLight, SigmaFallsWithStepsAndBaseline) {
  Device device;
  device.setup.projector_pose.orientation = Quat::Identity();
  device.setup.projector = Lens::from_fov(1280, 800, 1.0);
  const double one = mean_sigma(device, 1.0);
  Device steps = device;
  steps.setup.settings.steps *= 4;
  EXPECT_NEAR(one / mean_sigma(steps, 1.0), 2.0, 0.01);
  Device baseline = device;
  baseline.setup.projector_pose.position *= 0.5;
  EXPECT_NEAR(mean_sigma(baseline, 1.0) / one, 2.0, 0.04);  // the projector also stands more nearly in front
}

TEST(StructuredLight, ShadowBehindAStepIsAsWideAsGeometrySays) {
  // Seen and lit from above, a block of height h hides from the projector at +b what lies h * (x_edge - b) / (z - h)
  // beyond its edge on the far side.
  const double z = 1.0, h = 0.1, half = 0.02;
  Device device(0.3);
  device.setup.noise = false;
  Targets targets = plate(z);
  targets.add(box_target({2 * half, 0.5, h}), {Vec3(0, 0, z - 0.5 * h), Quat::Identity()});
  for (const bool decoded : {false, true}) {
    const Shot shot = shoot(targets, device, decoded);
    const double end = -half + (-half - 0.3) * h / (z - h);  // on the plate, x
    const double begin = -half * z / (z - h);                // where the camera sees past the block's top edge
    const double width = (begin - end) / z * device.camera.fx;
    for (int row = 60; row < 90; ++row) {
      int pixels = 0;
      for (int x = 0; x < device.camera.width; ++x) {
        pixels += shot.measured.validity[static_cast<std::size_t>(row) * device.camera.width + x] == Validity::shadow;
      }
      ASSERT_NEAR(pixels, width - 1.0, 1.0) << "row " << row;  // wholly in shadow: at each end a pixel is halved
    }
    EXPECT_GT(width, 5.0);
  }
}

TEST(StructuredLight, OutsideTheProjectorsFieldNothingIsMeasured) {
  Device device;
  device.setup.projector = Lens::from_fov(1280, 800, 0.2);
  Targets targets = plate(1.0);
  const Shot shot = shoot(targets, device, true);
  const Pose to_projector = device.setup.projector_pose.inverse();
  std::size_t outside = 0;
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
    const Vec3 ray = device.camera.ray(static_cast<double>(i % 200), static_cast<double>(i / 200));
    const auto pixel = device.setup.projector.project(to_projector * (shot.view.depth[i] * ray));
    const bool expected = !pixel || !device.setup.projector.inside(*pixel);
    // On the border of the field a pixel is outside with any part of it.
    const Lens& projector = device.setup.projector;
    const auto to_border = [](double at, int size) { return std::min(std::abs(at + 0.5), std::abs(at - size + 0.5)); };
    if (pixel && std::min(to_border(pixel->x(), projector.width), to_border(pixel->y(), projector.height)) < 6.0) {
      continue;  // a pixel of the camera is eleven of the projector's
    }
    EXPECT_EQ(shot.measured.validity[i] == Validity::outside, expected);
    outside += expected;
  }
  EXPECT_GT(outside, 5000u);
  EXPECT_LT(outside, 25000u);
}

TEST(StructuredLight, DarkSaturatedAndShinySurfacesDropOut) {
  Device device;
  Targets black = plate(1.0, 0.0, {0.003, 0.0, 0.4});
  EXPECT_GT(share(shoot(black, device, false), Validity::dark), 0.95);
  EXPECT_GT(share(shoot(black, device, true), Validity::dark), 0.95);
  Device bright = device;
  bright.setup.imager.exposure = 1.5;
  Targets white = plate(1.0, 0.0, {0.95, 0.0, 0.4});
  EXPECT_GT(share(shoot(white, bright, false), Validity::saturated), 0.95);
  EXPECT_GT(share(shoot(white, bright, true), Validity::saturated), 0.95);
  // The highlight of polished metal: half way between camera and projector.
  Targets shiny = plate(1.0, 0.0, {0.3, 0.6, 0.3});
  const Shot shot = shoot(shiny, device, false);
  EXPECT_GT(share(shot, Validity::saturated), 0.02);
  EXPECT_GT(share(shot, Validity::valid), 0.3);
}

/// A ball and a block on a plate, of different brightness.
Targets still_life() {
  Targets targets = plate(1.0);
  targets.add(ball_target(0.05, 5), {Vec3(-0.06, 0.0, 0.95), Quat::Identity()}, {0.8, 0.1, 0.4});
  targets.add(box_target({0.05, 0.08, 0.06}),
              {Vec3(0.07, 0.02, 0.95), Quat(Eigen::AngleAxisd(0.5, Vec3(1, 1, 1).normalized()))}, {0.1, 0.0, 0.4});
  return targets;
}

/// A bright plate beside a dark one: the short exposure leaves the dark one out, the long one the bright.
TEST(StructuredLight, EachPixelTakesTheLongestExposureThatDoesNotSaturate) {
  Targets targets;
  for (const int side : {-1, 1}) {
    targets.add(box_target({4.0, 8.0, 0.02}), {Vec3(2.0 * side, 0, 1.01), Quat::Identity()},
                {side < 0 ? 0.9 : 0.01, 0.0, 0.4});
  }
  for (const bool decoded : {false, true}) {
    Device device;
    device.setup.imager.ambient = 0.0;
    const auto valid = [&](double exposure, std::vector<double> exposures) {
      device.setup.imager.exposure = exposure;
      device.setup.imager.exposures = std::move(exposures);
      return share(shoot(targets, device, decoded), Validity::valid);
    };
    EXPECT_LT(valid(0.4, {}), 0.55);
    EXPECT_LT(valid(8.0, {}), 0.55);
    EXPECT_GT(valid(0.4, {0.4, 8.0}), 0.95);
    std::size_t count = 0;
    EXPECT_NEAR(over_predicted(targets, device, decoded, 20000, count), 1.0, 0.05);
    device.setup.imager.exposure = 0.8;
    device.setup.imager.exposures = {};
    const Shot alone = shoot(targets, device, decoded);
    device.setup.imager.exposures = {0.8};
    EXPECT_EQ(shoot(targets, device, decoded).measured.intensity, alone.measured.intensity);
  }
}

TEST(StructuredLight, BothFidelitiesAgree) {
  Targets targets = still_life();
  const Shot a = shoot(targets, Device(), false), d = shoot(targets, Device(), true);
  std::size_t same = 0;
  std::vector<double> of_analytic, of_decoded;  // errors / predicted sigma where both are valid
  for (std::size_t i = 0; i < a.sigma.size(); ++i) {
    same += a.measured.validity[i] == d.measured.validity[i];
    if (a.measured.validity[i] != Validity::valid || d.measured.validity[i] != Validity::valid) continue;
    if (std::isnan(a.sigma[i])) continue;  // half in shadow
    of_analytic.push_back(std::abs(a.measured.depth[i] - a.view.depth[i]) / a.sigma[i]);
    of_decoded.push_back(std::abs(d.measured.depth[i] - d.view.depth[i]) / d.sigma[i]);
  }
  EXPECT_GT(static_cast<double>(same) / static_cast<double>(a.sigma.size()), 0.98);
  ASSERT_GT(of_analytic.size(), 20000u);
  std::sort(of_analytic.begin(), of_analytic.end());
  std::sort(of_decoded.begin(), of_decoded.end());
  for (const double quantile : {0.5, 0.8}) {
    const auto at = static_cast<std::size_t>(quantile * static_cast<double>(of_analytic.size()));
    EXPECT_NEAR(of_analytic[at] / of_decoded[at], 1.0, 0.1) << quantile;
  }
  // Creases and borders of shadow, where a pixel sees two faces or half the light, make the largest errors.
  const auto mean_square = [](const std::vector<double>& values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_NEAR(std::sqrt(mean_square(of_analytic) / mean_square(of_decoded)), 1.0, 0.1);
  EXPECT_GT(share(a, Validity::mixed), 0.001);
  EXPECT_GT(share(a, Validity::shadow), 0.01);
}

TEST(StructuredLight, KeptMixedPixelsFlyBetweenSurfaces) {
  Targets targets = still_life();
  Device device;
  device.setup.settings.mixed = MixedPixels::keep;
  for (const bool decoded : {false, true}) {
    const Shot kept = shoot(targets, device, decoded);
    EXPECT_EQ(share(kept, Validity::mixed), 0.0);
    EXPECT_GT(errors(kept).back(), 0.003);
  }
}

TEST(StructuredLight, SameSeedSameBits) {
  Targets targets = still_life();
  for (const bool decoded : {false, true}) {
    const Shot a = shoot(targets, Device(), decoded, 5), b = shoot(targets, Device(), decoded, 5),
               c = shoot(targets, Device(), decoded, 6);
    const auto bits = [](const Shot& s) {
      std::vector<double> values;
      for (const double z : s.measured.depth) values.push_back(std::isnan(z) ? -1.0 : z);
      return values;
    };
    EXPECT_EQ(bits(a), bits(b));
    EXPECT_NE(bits(a), bits(c));
  }
}

TEST(StructuredLight, ABallOf100MillimetresHasItsRadius) {
  Targets targets;
  targets.add(ball_target(0.1), {Vec3(0, 0, 1.05), Quat::Identity()});
  Device device;
  device.camera = Lens::from_fov(400, 300, 0.27);
  for (const bool noise : {false, true}) {
    device.setup.noise = noise;
    for (const bool decoded : {false, true}) {
      const Shot shot = shoot(targets, device, decoded);
      std::vector<Vec3> points;
      for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
        const auto width = static_cast<std::size_t>(device.camera.width);
        if (shot.measured.validity[i] != Validity::valid) continue;
        points.push_back(shot.measured.depth[i] *
                         device.camera.ray(static_cast<double>(i % width), static_cast<double>(i / width)));
      }
      const BallFit ball = fit_ball(points);
      const double bound = noise ? 5e-5 : 1e-5;
      EXPECT_NEAR(ball.radius, 0.1, bound) << noise << decoded;
      EXPECT_LT((ball.center - Vec3(0, 0, 1.05)).norm(), 5.0 * bound) << noise << decoded;
    }
  }
}

}  // namespace
}  // namespace bin_scenes
