// What a pixel's extent and the lens's blur make of edges of surfaces, light and albedo, against integrals of the
// test's own.
#include "sensor/models/structured_light.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace bin_scenes {
namespace {

/// A camera at the origin of the world that looks along z, and a projector at a baseline on its right.
struct Device {
  Lens camera = Lens::from_fov(200, 60, 0.35);
  StructuredLight::Setup setup;

  explicit Device(double baseline) {
    setup.projector = Lens::from_fov(1280, 800, 0.8);
    setup.projector_pose = {Vec3(baseline, 0.0, 0.0), Quat::Identity()};
    setup.near = 0.05;
    setup.far = 10.0;
    setup.noise = false;
    setup.imager.bits = 16;
    setup.settings.mixed = MixedPixels::keep;
  }
};

void add_plate(Targets& targets, const Vec3& front, const Vec3& size, double albedo, double turn = 0.0) {
  targets.add(box_target(size), {front + Vec3(0, 0, 0.5 * size.z()), Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()))},
              {albedo, 0.0, 0.4});
}

struct Shot {
  View view;
  Measurement measured;
};

Shot shoot(Targets& targets, const Device& device, bool decoded) {
  const Scenery scenery = targets.scenery();
  Shot shot{render(scenery, device.camera, Pose(), device.setup.near, device.setup.far), Measurement(0)};
  const StructuredLight model(scenery, shot.view, targets.surfaces(), device.setup);
  shot.measured = decoded ? model.decoded(Random(1, 0, Stream::noise)) : model.analytic(Random(1, 0, Stream::noise));
  return shot;
}

/// Column and signal of the projector's light on a plate that faces the camera.
struct Light {
  double column, signal;
};
Light light_on_plate(const Device& device, double u, double v, double z, double albedo) {
  const Vec3 point = z * device.camera.ray(u, v), way = device.setup.projector_pose.position - point;
  const double distance = way.norm();
  return {device.setup.projector.project(device.setup.projector_pose.inverse() * point)->x(),
          albedo * -way.z() / (distance * distance * distance)};
}

/// Column that the common phase of lights names, next to the brightest.
double common_column(const std::vector<Light>& lights, double period) {
  const auto top = std::max_element(lights.begin(), lights.end(),
                                    [](const Light& a, const Light& b) { return a.signal < b.signal; });
  double sine = 0.0, cosine = 0.0;
  for (const Light& l : lights) {
    sine += l.signal * std::sin(2.0 * M_PI * (l.column - top->column) / period);
    cosine += l.signal * std::cos(2.0 * M_PI * (l.column - top->column) / period);
  }
  return top->column + std::atan2(sine, cosine) * period / (2.0 * M_PI);
}

double depth_of(const Device& device, double u, double v, double column) {
  return Triangulation(device.setup.projector, device.setup.projector_pose).depth(device.camera.ray(u, v), column);
}

TEST(Footprint, OverAStepAPixelMixesBothSurfacesByTheirShares) {
  Device device(0.05);
  device.setup.settings.period = 40.0;
  const double turn = 0.021;  // the edge passes every share of a pixel
  Targets targets;
  add_plate(targets, {-1.0, 0.0, 0.70}, {2.0, 2.0, 0.01}, 0.6, turn);
  add_plate(targets, {0.0, 0.0, 0.75}, {4.0, 4.0, 0.01}, 0.6);
  const auto on_near = [&](double u, double v) {
    const Vec3 there = 0.70 * device.camera.ray(u, v) - Vec3(-1.0, 0.0, 0.70);
    return there.x() * std::cos(turn) + there.y() * std::sin(turn) < 1.0;
  };
  constexpr int fine = 24;
  for (const bool decoded : {false, true}) {
    const Shot shot = shoot(targets, device, decoded);
    std::set<long> depths;
    double worst = 0.0, sum = 0.0;
    int crossed = 0;
    for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
      const double x = static_cast<double>(i % 200), y = static_cast<double>(i / 200);
      std::vector<Light> lights;
      int near = 0;
      for (int k = 0; k < fine * fine; ++k) {
        const double u = x + (k % fine + 0.5) / fine - 0.5, v = y + (k / fine + 0.5) / fine - 0.5;
        near += on_near(u, v);
        lights.push_back(light_on_plate(device, u, v, on_near(u, v) ? 0.70 : 0.75, 0.6));
      }
      if (near == 0 || near == fine * fine) continue;
      ASSERT_EQ(shot.measured.validity[i], Validity::valid);
      const double off = std::abs(shot.measured.depth[i] -
                                  depth_of(device, x, y, common_column(lights, device.setup.settings.period)));
      worst = std::max(worst, off);
      sum += off;
      ++crossed;
      depths.insert(std::lround(1e4 * shot.measured.depth[i]));
    }
    ASSERT_GT(crossed, 50);
    EXPECT_LT(worst, 0.008) << decoded;  // an eighth of the step, where a column of samples begins
    EXPECT_LT(sum / crossed, 0.0025) << decoded;
    EXPECT_GT(depths.size(), 12u) << decoded;
  }
}

TEST(Footprint, PixelsHalfOutsideTheProjectorsFieldAreOutside) {
  Device device(0.1112);
  device.camera = Lens::from_fov(486, 300, 0.997);
  device.setup.projector = Lens::from_fov(1280, 720, 1.001);
  Targets targets;
  add_plate(targets, {0, 0, 0.624}, {4.0, 4.0, 0.01}, 0.6);
  for (const bool decoded : {false, true}) {
    const Shot shot = shoot(targets, device, decoded);
    std::size_t valid = 0, outside = 0;
    for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
      valid += shot.measured.validity[i] == Validity::valid;
      outside += shot.measured.validity[i] == Validity::outside;
      if (shot.measured.validity[i] != Validity::valid) continue;
      ASSERT_NEAR(shot.measured.depth[i], 0.624, decoded ? 1e-4 : 1e-9) << decoded << " " << i % 486;
    }
    EXPECT_GT(valid, 90000u);
    EXPECT_GT(outside, 20000u);
    EXPECT_EQ(valid + outside, shot.view.depth.size());
  }
}

TEST(Footprint, WhereAShadowEndsPixelsFadeIntoTheLight) {
  Device device(0.2);
  Targets targets;
  add_plate(targets, {0, 0, 1.0}, {4.0, 4.0, 0.01}, 0.6);
  add_plate(targets, {0.06, 0, 0.6}, {0.03, 0.03, 0.01}, 0.6, 0.3);  // its shadow lies to the left of its image
  const Scenery scenery = targets.scenery();
  constexpr int fine = 12;
  for (const bool decoded : {false, true}) {
    const Shot shot = shoot(targets, device, decoded);
    const auto all_plate = [&](std::size_t i) {
      for (const int d : {-201, -200, -199, -1, 0, 1, 199, 200, 201}) {
        const auto at = static_cast<std::ptrdiff_t>(i) + d;
        if (at < 0 || at >= 12000 || shot.view.label[static_cast<std::size_t>(at)] != 1) return false;
      }
      return true;
    };
    int fading = 0, dark = 0, wrong = 0;
    for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
      if (!all_plate(i)) continue;
      std::vector<Ray> rays;
      for (int k = 0; k < fine * fine; ++k) {
        const Vec3 point = device.camera.ray(static_cast<double>(i % 200) + (k % fine + 0.5) / fine - 0.5,
                                             static_cast<double>(i / 200) + (k / fine + 0.5) / fine - 0.5);
        rays.push_back(ray_between(point, -Vec3::UnitZ(), device.setup.projector_pose.position));
      }
      std::vector<std::uint8_t> blocked(rays.size());
      scenery.blocked(rays.data(), blocked.data(), rays.size());
      const auto lit = std::count(blocked.begin(), blocked.end(), 0) / static_cast<double>(rays.size());
      const Validity code = shot.measured.validity[i];
      if (lit == 0.0) {
        ++dark;
        wrong += code != Validity::shadow;
      } else if (lit > 0.25) {
        fading += lit < 0.5;
        wrong += code != Validity::valid;
      }
    }
    EXPECT_GT(dark, 200) << decoded;
    EXPECT_GT(fading, 10) << decoded;
    EXPECT_EQ(wrong, 0) << decoded;
  }
}

/// The border of a shadow is a straight line on the plate that crosses pixels at every share.
TEST(Footprint, AtAShadowsBorderTheSignalFollowsTheShareThatIsLit) {
  constexpr int fine = 16;
  const double turn = 0.021, z = 1.0, between = 0.6;
  for (const double blur : {0.0, 0.6}) {
    Device device(0.2);
    device.setup.imager.blur = blur;
    device.setup.imager.ambient = 0.0;
    device.setup.imager.reference_distance = z;
    Targets empty, targets;
    for (Targets* const all : {&empty, &targets}) add_plate(*all, {0, 0, z}, {4.0, 4.0, 0.01}, 0.6);
    add_plate(targets, {0.06, 0, between}, {0.03, 2.0, 0.01}, 0.6, turn);
    const Vec3 light = device.setup.projector_pose.position;
    const auto lit_at = [&](double u, double v) {
      const Vec3 passed = light + between / z * (z * device.camera.ray(u, v) - light) - Vec3(0.06, 0.0, between);
      return passed.x() * std::cos(turn) + passed.y() * std::sin(turn) < -0.015;
    };
    const auto below = [&](double x) { return 0.5 * std::erfc(-x / (blur * std::sqrt(2.0))); };
    const auto weight = [&](double d) {
      return blur > 0.0 ? below(d + 0.5) - below(d - 0.5) : std::abs(d) < 0.5 ? 1.0 : 0.0;
    };
    for (const bool decoded : {false, true}) {
      const Shot bright = shoot(empty, device, decoded), shot = shoot(targets, device, decoded);
      double worst = 0.0, sum = 0.0;
      int crossed = 0, wrong = 0;
      for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
        const int x = static_cast<int>(i % 200), y = static_cast<int>(i / 200);
        if (x < 58 || x > 74 || y < 3 || y > 56) continue;  // far from the border; rows that lack neighbours
        double lit = 0.0, all = 0.0;
        const int reach = blur > 0.0 ? 2 : 0;
        for (int k = -reach * fine; k < (reach + 1) * fine; ++k) {
          for (int l = -reach * fine; l < (reach + 1) * fine; ++l) {
            const double u = (k + 0.5) / fine - 0.5, v = (l + 0.5) / fine - 0.5, w = weight(u) * weight(v);
            all += w;
            lit += lit_at(x + u, y + v) ? w : 0.0;
          }
        }
        const double share = lit / all;
        if (share < 0.01 || share > 0.99) continue;
        const double off = std::abs(shot.measured.intensity[i] / bright.measured.intensity[i] - share);
        worst = std::max(worst, off), sum += off, ++crossed;
        wrong += share > 0.1 && shot.measured.validity[i] != Validity::valid;
      }
      ASSERT_GT(crossed, 50);
      EXPECT_LT(worst, 1.0 / 16.0) << blur << " " << decoded;  // a cell
      EXPECT_LT(sum / crossed, blur > 0.0 ? 0.004 : 0.02) << blur << " " << decoded;
      EXPECT_EQ(wrong, 0) << blur << " " << decoded;
    }
  }
}

/// Two plates of one plane that meet in the column `border` of the image's middle row. Each pixel's light is weighted
/// by the blur over the pixel's box. Returns the largest error of depth.
double contrast_error(double border, double blur, bool decoded) {
  const double z = 0.7;
  Device device(0.1);
  device.setup.imager.blur = blur;
  device.setup.settings.min_modulation = 1e-6;
  const double edge = z * device.camera.ray(border, 30).x();
  Targets targets;
  add_plate(targets, {edge - 1.0, 0, z}, {2.0, 4.0, 0.01}, 0.9);
  add_plate(targets, {edge + 1.0, 0, z}, {2.0, 4.0, 0.01}, 0.05);
  const auto below = [&](double x) {
    return blur > 0.0 ? 0.5 * std::erfc(-x / (blur * std::sqrt(2.0))) : x > 0.0 ? 1.0 : 0.0;
  };
  const Shot shot = shoot(targets, device, decoded);
  double largest = 0.0;
  for (int x = 90; x < 110; ++x) {
    std::vector<Light> lights;
    for (double d = -4.0 + 1.0 / 128; d < 4.0; d += 1.0 / 64) {
      lights.push_back(light_on_plate(device, x + d, 30, z, x + d < border ? 0.9 : 0.05));
      lights.back().signal *= below(d + 0.5) - below(d - 0.5);
    }
    const double expected = depth_of(device, x, 30, common_column(lights, device.setup.settings.period)) - z;
    const std::size_t i = 30 * 200 + static_cast<std::size_t>(x);
    EXPECT_EQ(shot.measured.validity[i], Validity::valid);
    EXPECT_NEAR(shot.measured.depth[i] - z, expected, 1e-4) << border << " " << blur << " " << decoded << " " << x;
    largest = std::max(largest, std::abs(shot.measured.depth[i] - z));
    if (x < 96 || x > 103) {
      EXPECT_NEAR(shot.measured.depth[i], z, decoded ? 5e-5 : 1e-9) << x;
    }
  }
  return largest;
}

TEST(Footprint, ABorderOfDarkAndBrightDrawsTheDepth) {
  for (const bool decoded : {false, true}) contrast_error(99.25, 0.0, decoded);
}

TEST(Footprint, ABlurredBorderDrawsTheDepthWhereverItCrossesAPixel) {
  for (const bool decoded : {false, true}) {
    double smallest = 1.0, largest = 0.0;
    for (const double border : {99.5, 99.75, 100.0, 100.25}) {  // 99.5: between two pixels
      const double error = contrast_error(border, 0.6, decoded);
      smallest = std::min(smallest, error), largest = std::max(largest, error);
    }
    EXPECT_GT(smallest, 5e-4) << decoded;
    EXPECT_LT(largest, 1.5 * smallest) << decoded;
  }
}

/// A plate with rust. Light of the projector and of the surroundings is that of each point's surface, weighted by the
/// blur over the pixel's box.
TEST(Footprint, BordersOfTextureDrawTheDepthAndSendBackTheirAmbientLight) {
  constexpr int fine = 12, reach = 2, row = 30;
  const double z = 0.7, blur = 0.6;
  Targets targets;
  add_plate(targets, {0, 0, z}, {4.0, 4.0, 0.01}, 0.9);
  const Scenery scenery = targets.scenery();
  Surfaces surfaces = targets.surfaces();
  surfaces.lines[0].texture.rust = 0.4;
  surfaces.places.assign(2, {Pose(), Vec3::UnitX(), 7});
  for (const double exposure : {0.8, 1e-6}) {
    Device device(0.1);
    device.setup.imager.blur = blur;
    device.setup.imager.exposure = exposure;
    device.setup.imager.ambient = exposure < 0.01 ? 0.5 : 0.0;
    device.setup.settings.min_modulation = 1e-6;
    const View view = render(scenery, device.camera, Pose(), device.setup.near, device.setup.far);
    const StructuredLight model(scenery, view, surfaces, device.setup);
    const auto below = [&](double x) { return 0.5 * std::erfc(-x / (blur * std::sqrt(2.0))); };
    const auto weight = [&](double d) { return below(d + 0.5) - below(d - 0.5); };
    const auto expected = [&](int x) {
      std::vector<Light> lights;
      double ambient = 0.0, all = 0.0;
      for (int k = -reach * fine; k < (reach + 1) * fine; ++k) {
        for (int l = -reach * fine; l < (reach + 1) * fine; ++l) {
          const double u = (k + 0.5) / fine - 0.5, v = (l + 0.5) / fine - 0.5, w = weight(u) * weight(v);
          Surface own;
          const double albedo = diffuse_share(surfaces.at(0, 1, z * device.camera.ray(x + u, row + v), own));
          lights.push_back(light_on_plate(device, x + u, row + v, z, albedo));
          lights.back().signal *= w;
          ambient += w * albedo, all += w;
        }
      }
      return std::make_pair(depth_of(device, x, row, common_column(lights, device.setup.settings.period)),
                            ambient / all);
    };
    for (const bool decoded : {false, true}) {
      const Random random(1, 0, Stream::noise);
      const Measurement measured = decoded ? model.decoded(random) : model.analytic(random);
      double drawn = 0.0;
      for (int x = 5; x < 195; ++x) {
        const auto [depth, ambient] = expected(x);
        const std::size_t i = row * 200 + static_cast<std::size_t>(x);
        if (exposure < 0.01) {
          EXPECT_NEAR(measured.intensity[i], 0.5 * ambient, 0.025) << x << " " << decoded;
          continue;
        }
        drawn = std::max(drawn, std::abs(depth - z));
        EXPECT_NEAR(measured.depth[i], depth, 4e-4) << x << " " << decoded;
      }
      if (exposure > 0.01) {
        EXPECT_GT(drawn, 2e-3);
      }
    }
  }
}

}  // namespace
}  // namespace bin_scenes
