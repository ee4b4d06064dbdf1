#include "sensor/models/stereo.hpp"
#include "sensor/shot.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

struct Device {
  Lens camera = Lens::from_fov(320, 240, 0.7);
  Stereo::Setup setup;

  Device() {
    setup.settings.baseline = 0.1;
    setup.settings.disparities = 64;
    setup.projector = Lens::from_fov(800, 600, 0.9);
    setup.projector_pose.position = Vec3(0.05, 0.0, 0.0);
    setup.near = 0.5;
    setup.far = 5.0;
  }
};

using test::Shot;
Shot shoot(Targets& targets, const Device& device, bool decoded, std::uint64_t seed = 1) {
  return test::shoot<Stereo>(targets, device.camera, device.setup, decoded, seed);
}

void add_plate(Targets& targets, double z, double tilt = 0.0) {
  const Quat turn(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
  targets.add(box_target({6.0, 6.0, 0.02}), {Vec3(0, 0, z) + turn * Vec3(0, 0, 0.01), turn}, {0.6, 0.0, 0.4});
}

/// Error of the disparity, NaN where there is none.
std::vector<double> disparity_errors(const Shot& shot, const Device& device) {
  std::vector<double> errors;
  const double scale = device.camera.fx * device.setup.settings.baseline;
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
    errors.push_back(scale / shot.measured.depth[i] - scale / shot.view.depth[i]);
  }
  return errors;
}

double correlation(const std::vector<double>& errors, int width, int lag) {
  double product = 0.0, square = 0.0;
  std::size_t pairs = 0, n = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!(std::abs(errors[i]) < 1.0)) continue;
    square += errors[i] * errors[i];
    ++n;
    if (static_cast<int>(i) % width + lag >= width || !(std::abs(errors[i + lag]) < 1.0)) continue;
    product += errors[i] * errors[i + lag];
    ++pairs;
  }
  return product / static_cast<double>(pairs) / (square / static_cast<double>(n));
}

TEST(Stereo, MatchesAPlateWithinAFractionOfAPixel) {
  Targets targets;
  add_plate(targets, 1.0);
  const Device device;
  const Shot shot = shoot(targets, device, true);
  std::vector<double> errors;
  for (const double e : disparity_errors(shot, device)) {
    if (!std::isnan(e)) errors.push_back(std::abs(e));
  }
  ASSERT_GT(static_cast<double>(errors.size()) / static_cast<double>(shot.view.depth.size()), 0.7);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05);
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.5);
}

/// Mean and root mean square of the errors of right matches.
struct Spread {
  double mean = 0.0, rms = 0.0;
  std::size_t count = 0;
};
Spread spread_of(const std::vector<double>& errors) {
  Spread s;
  for (const double e : errors) {
    if (!(std::abs(e) < 1.0)) continue;
    s.mean += e;
    s.rms += e * e;
    ++s.count;
  }
  s.mean /= static_cast<double>(s.count);
  s.rms = std::sqrt(s.rms / static_cast<double>(s.count));
  return s;
}

TEST(Stereo, IsNotDrawnToWholeDisparities) {
  Device fine, coarse;  // dots of one pixel of the camera, and of three, as of a compact camera
  fine.setup.imager.exposure = coarse.setup.imager.exposure = 1.3;
  coarse.setup.projector = Lens::from_fov(250, 190, 0.9);
  for (const Device& device : {fine, coarse}) {
    for (const int sixteenths : {0, 2, 6, 8, 10, 14}) {  // what a match can tell
      Targets targets;
      add_plate(targets, device.camera.fx * device.setup.settings.baseline / (40.0 + sixteenths / 16.0));
      const Spread s = spread_of(disparity_errors(shoot(targets, device, true), device));
      ASSERT_GT(s.count, 40000u);
      EXPECT_LT(std::abs(s.mean), 0.02) << sixteenths;
      EXPECT_LT(s.rms, 0.07) << sixteenths;
    }
  }
}

TEST(Stereo, WithoutDotsNoiseIsNotMatched) {
  Targets plain, edged;
  add_plate(plain, 1.0);
  add_plate(edged, 1.0);
  edged.add(box_target({0.3, 0.3, 0.002}), {Vec3(0, 0, 0.99), Quat::Identity()}, {0.05, 0.0, 0.4});
  Device device;
  const auto matched = [&](Targets& targets, bool decoded) {
    const auto& v = shoot(targets, device, decoded).measured.validity;
    return static_cast<double>(std::count(v.begin(), v.end(), Validity::valid)) / static_cast<double>(v.size());
  };
  for (const bool decoded : {false, true}) {
    device.setup.settings.dots = 0.12;
    EXPECT_GT(matched(plain, decoded), 0.7) << decoded;
    device.setup.settings.dots = 0.0;
    EXPECT_LT(matched(plain, decoded), 1e-3) << decoded;
    EXPECT_GT(matched(edged, decoded), 0.005) << decoded;  // the border of dark and bright
    EXPECT_LT(matched(edged, decoded), 0.15) << decoded;
  }
}

TEST(Stereo, ErrorsOfNeighboursResembleEachOtherOverTheWindow) {
  Targets targets;
  add_plate(targets, 1.0, 0.3);
  Device device;
  for (const bool decoded : {true, false}) {
    for (const int window : {5, 11}) {
      device.setup.settings.window = window;
      const std::vector<double> errors = disparity_errors(shoot(targets, device, decoded), device);
      const double near = correlation(errors, device.camera.width, 1);
      const double half = correlation(errors, device.camera.width, window / 2);
      const double beyond = correlation(errors, device.camera.width, 3 * window);
      EXPECT_GT(near, 0.3) << decoded << window;  // white noise has 0 +- 0.004
      EXPECT_GT(near, half) << decoded << window;
      EXPECT_GT(half, beyond) << decoded << window;
      EXPECT_LT(std::abs(beyond), 0.15) << decoded << window;
    }
  }
}

TEST(Stereo, AnalyticNoiseIsAsPredicted) {
  for (const double z : {0.7, 1.0, 2.0}) {
    Targets targets;
    add_plate(targets, z);
    Device device;
    double sum = 0.0;
    std::size_t n = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const Shot shot = shoot(targets, device, false, seed);
      for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
        if (shot.measured.validity[i] != Validity::valid) continue;
        sum += std::pow((shot.measured.depth[i] - shot.view.depth[i]) / shot.sigma[i], 2);
        ++n;
      }
    }
    ASSERT_GT(n, 100000u);
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(n)), 1.0, 0.04) << z;  // as many independent samples as windows
  }
}

TEST(Stereo, WhatTheSecondCameraDoesNotSeeIsUnmatched) {
  Targets targets;
  add_plate(targets, 1.5);
  targets.add(box_target({0.2, 0.3, 0.02}), {Vec3(0, 0, 1.0), Quat::Identity()}, {0.6, 0.0, 0.4});
  const Device device;
  const Shot shot = shoot(targets, device, false);
  // To the left of the near plate, as wide as the difference of the disparities.
  const double front = 0.99, back = 1.5;
  const double expected = device.camera.fx * device.setup.settings.baseline * (1.0 / front - 1.0 / back);
  const int edge = static_cast<int>(std::lround(0.5 * (device.camera.width - 1) - 0.1 / front * device.camera.fx));
  for (int y = 100; y < 140; ++y) {
    int hidden = 0;
    for (int x = edge - 40; x < edge; ++x) {
      hidden += shot.measured.validity[static_cast<std::size_t>(y) * device.camera.width + x] == Validity::unmatched;
    }
    ASSERT_NEAR(hidden, expected, 1.5);
  }
}

TEST(Stereo, SameSeedSameBits) {
  Targets targets;
  add_plate(targets, 1.0);
  const auto images = [&](std::uint64_t seed) {
    const Scenery scenery = targets.scenery();
    const Device device;
    const View view = render(scenery, device.camera, Pose(), 0.05, 10.0);
    return Stereo(scenery, view, targets.surfaces(), device.setup).images(Random(seed, 0, Stream::noise));
  };
  EXPECT_EQ(images(3).first, images(3).first);
  EXPECT_EQ(images(3).second, images(3).second);
  EXPECT_NE(images(3).first, images(4).first);
}

TEST(Stereo, LightOfAnotherFaceIsHazeOverTheDots) {
  for (const bool wall : {false, true}) {
    Targets targets;
    add_plate(targets, 1.0);
    if (wall) targets.add(box_target({0.02, 2.0, 0.4}), {Vec3(0.3, 0.0, 0.8), Quat::Identity()}, {0.9, 0.0, 0.4});
    const Scenery scenery = targets.scenery();
    Device device;
    const View view = render(scenery, device.camera, Pose(), device.setup.near, device.setup.far);
    device.setup.noise = false;
    const Stereo direct(scenery, view, targets.surfaces(), device.setup);
    device.setup.indirect.bounces = 1;
    const Stereo both(scenery, view, targets.surfaces(), device.setup);
    const Random random(1, 0, Stream::noise);
    const Stereo::Pair a = direct.images(random), b = both.images(random);
    EXPECT_EQ(a.first == b.first, !wall);
    EXPECT_EQ(a.second == b.second, !wall);
    if (!wall) continue;
    // Beside the wall and far from it on the plate: grey levels, mean.
    const auto added = [&](int left) {
      double sum = 0.0;
      for (int y = 100; y < 140; ++y) {
        for (int x = left; x < left + 12; ++x) {
          const std::size_t i = static_cast<std::size_t>(y * device.camera.width + x);
          sum += int(b.first[i]) - int(a.first[i]);
        }
      }
      return sum / 480.0;
    };
    const double beside = added(250), far = added(40);
    EXPECT_GT(beside, 2.0);
    EXPECT_GT(beside, 2.5 * far);
    EXPECT_GT(far, 0.1);
  }
}

TEST(Stereo, AmbientLightIsThatOfTheWornSurface) {
  Targets targets;
  add_plate(targets, 1.0);
  const Scenery scenery = targets.scenery();
  Surfaces surfaces = targets.surfaces();
  surfaces.lines[0].texture.rust = 1.0;  // all of it
  surfaces.places.assign(2, {Pose(), Vec3::UnitX(), 7});
  Device device;
  device.setup.noise = false;
  device.setup.imager.exposure = 1e-6;
  device.setup.imager.ambient = 0.5;
  const View view = render(scenery, device.camera, Pose(), device.setup.near, device.setup.far);
  Surface own;
  const double grey = 255.0 * 0.5 * diffuse_share(surfaces.at(0, 1, Vec3::UnitZ(), own));
  ASSERT_LT(grey, 40.0) << "the plate without rust sends back 76";
  const Stereo::Pair images = Stereo(scenery, view, surfaces, device.setup).images(Random(1, 0, Stream::noise));
  for (const std::vector<std::uint8_t>& image : {images.first, images.second})
    for (const std::uint8_t value : image) ASSERT_NEAR(value, grey, 1.0);
}

TEST(Stereo, AmbientLightAddsItsNoiseAndSaturates) {
  Targets targets;
  add_plate(targets, 1.0);
  Device device;
  device.setup.imager.read_noise = 0.0;
  device.setup.imager.bits = 16;  // what is left is shot noise: its variance goes with all light
  const auto lit_by = [&](double ambient) {
    device.setup.imager.ambient = ambient;
    return shoot(targets, device, false);
  };
  const Shot dark = lit_by(0.0), day = lit_by(0.3), sun = lit_by(2.0);
  const std::size_t middle = dark.sigma.size() / 2 + 160;
  const double s = dark.measured.intensity[middle];
  EXPECT_NEAR(day.measured.intensity[middle], s + 0.3 * 0.6, 1e-6);
  const double depth = dark.view.depth[middle], step = depth * depth / (device.camera.fx * 0.1) / 16.0;
  const auto of_light = [&](const Shot& shot) { return std::pow(shot.sigma[middle], 2) - step * step / 12.0; };
  EXPECT_NEAR(of_light(day) / of_light(dark), (s + 0.3 * 0.6) / s, 1e-3);
  EXPECT_EQ(sun.measured.validity[middle], Validity::saturated) << "as the images of `decoded` are";
}

/// A bright and a dark half, of which one exposure loses one. A pixel is that of the longer exposure, bit for bit,
/// where that one finds it and does not saturate, else that of the shorter.
TEST(Stereo, ExposuresAreMerged) {
  Targets targets;
  targets.add(box_target({6.0, 3.0, 0.02}), {Vec3(0, 1.5, 1.01), Quat::Identity()}, {0.9, 0.0, 0.4});
  targets.add(box_target({6.0, 3.0, 0.02}), {Vec3(0, -1.5, 1.01), Quat::Identity()}, {0.01, 0.0, 0.4});
  Device device;
  device.setup.noise = false;
  device.setup.imager.reference_distance = 1.0;
  const auto with = [&](const std::vector<double>& exposures, bool decoded) {
    device.setup.imager.exposures = exposures;
    return shoot(targets, device, decoded).measured;
  };
  constexpr double ratio = 50.0;  // to the exposure 0.8 of grey values
  for (const bool decoded : {false, true}) {
    const Measurement brief = with({0.8}, decoded), lasting = with({0.8 * ratio}, decoded);
    const Measurement merged = with({0.8, 0.8 * ratio}, decoded);
    std::size_t as_brief = 0, as_lasting = 0;
    for (std::size_t i = 0; i < merged.depth.size(); ++i) {
      const bool white = decoded && lasting.intensity[i] > (1.0 - 1e-6) / ratio;
      const bool longer = lasting.validity[i] == Validity::valid && !white;
      const Measurement& own = longer ? lasting : brief;
      ASSERT_EQ(merged.validity[i], own.validity[i]);
      if (merged.validity[i] != Validity::valid) continue;
      ASSERT_EQ(merged.depth[i], own.depth[i]);
      ASSERT_EQ(merged.snr[i], own.snr[i]);
      ++(longer ? as_lasting : as_brief);
    }
    EXPECT_GT(as_brief, 20000u) << decoded;
    EXPECT_GT(as_lasting, 20000u) << decoded;
    const auto count = [](const Measurement& m) {
      return std::count(m.validity.begin(), m.validity.end(), Validity::valid);
    };
    EXPECT_GT(count(merged), count(brief) + 20000) << decoded;
    EXPECT_GT(count(merged), count(lasting) + 5000) << decoded;
    const Measurement none = with({}, decoded);
    EXPECT_EQ(none.validity, brief.validity);
    EXPECT_EQ(none.snr, brief.snr);
  }
}

}  // namespace
}  // namespace bin_scenes
