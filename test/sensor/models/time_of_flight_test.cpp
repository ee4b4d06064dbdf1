#include "sensor/models/time_of_flight.hpp"
#include "sensor/models/time_of_flight_noise.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes {
namespace {

constexpr int width = 240, height = 180;

struct Shot {
  View view;
  Measurement measured;
};

Shot shoot(Targets& targets, const TimeOfFlightSettings& settings, bool noise, std::uint64_t seed = 1) {
  const Scenery scenery = targets.scenery();
  Shot shot{render(scenery, Lens::from_fov(width, height, 0.5), Pose(), 0.05, 10.0), Measurement(0)};
  shot.measured = time_of_flight(scenery, shot.view, targets.surfaces(), {settings, noise, 0.05, 10.0},
                                 Random(seed, 0, Stream::noise));
  return shot;
}

void add_plate(Targets& targets, double z, double tilt, double albedo, double size = 8.0) {
  const Quat turn(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
  targets.add(box_target({size, size, 0.02}), {Vec3(0, 0, z) + turn * Vec3(0, 0, 0.01), turn}, {albedo, 0.0, 0.4});
}

TEST(TimeOfFlight, AxialNoiseIsThatOfTheFormula) {
  const TimeOfFlightSettings settings;
  for (const double z : {0.5, 2.0}) {
    for (const double degrees : {0.0, 60.0}) {
      for (const double albedo : {0.2, 0.9}) {
        Targets targets;
        add_plate(targets, z, degrees * M_PI / 180.0, albedo);
        const Shot shot = shoot(targets, settings, true);
        double sum = 0.0;
        std::size_t n = 0;
        for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
          if (shot.measured.validity[i] != Validity::valid) continue;
          const auto& normal = shot.view.normal[i];
          const Vec3 ray =
              shot.view.lens.ray(static_cast<double>(i % width), static_cast<double>(i / width)).normalized();
          const double incidence = std::acos(-ray.dot(Vec3(normal[0], normal[1], normal[2])));
          const double sigma = axial_sigma(settings, shot.view.depth[i], incidence, albedo);
          sum += std::pow((shot.measured.depth[i] - shot.view.depth[i]) / sigma, 2);
          ++n;
        }
        ASSERT_GT(n, 30000u);
        EXPECT_NEAR(std::sqrt(sum / static_cast<double>(n)), 1.0, 0.03) << z << " " << degrees << " " << albedo;
      }
    }
  }
}

TEST(TimeOfFlight, WithoutNoiseAPlaneIsExact) {
  Targets targets;
  add_plate(targets, 1.0, 0.7, 0.5);
  const Shot shot = shoot(targets, {}, false);
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
    ASSERT_NEAR(shot.measured.depth[i], shot.view.depth[i], 1e-12);
  }
}

TEST(TimeOfFlight, EdgesAreMovedByTheLateralNoiseAndMixed) {
  Targets targets;
  add_plate(targets, 1.0, 0.0, 0.5, 0.2);
  add_plate(targets, 1.6, 0.0, 0.5);
  TimeOfFlightSettings settings;
  settings.lateral = 1.5;
  const Shot shot = shoot(targets, settings, true);
  // Along the left edge of the small plate: pixels that see the other surface than their centre, by distance from it.
  const double edge = 0.5 * (width - 1) - 0.1 * shot.view.lens.fx;
  std::size_t crossed = 0, far_crossed = 0, mixed = 0, rows = 0;
  for (int y = 70; y < 110; ++y, ++rows) {
    for (int x = 0; x < width / 2; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      const double error = std::abs(shot.measured.depth[i] - shot.view.depth[i]);
      const bool between = shot.measured.depth[i] > 1.05 && shot.measured.depth[i] < 1.55;
      mixed += between;
      crossed += error > 0.3;
      far_crossed += error > 0.05 && std::abs(x - edge) > 5.5 * settings.lateral;
    }
  }
  EXPECT_GT(static_cast<double>(crossed) / static_cast<double>(rows),
            0.5);  // a normal jitter crosses 0.4 sigma on each side
  EXPECT_LT(static_cast<double>(crossed) / static_cast<double>(rows), 1.6);
  EXPECT_GT(mixed, 10u);
  EXPECT_EQ(far_crossed, 0u);

  settings.mixed = MixedPixels::remove;
  const Shot removed = shoot(targets, settings, true);
  EXPECT_GT(std::count(removed.measured.validity.begin(), removed.measured.validity.end(), Validity::mixed), 10);
}

TEST(TimeOfFlight, OverAStepAPixelMixesBothDepthsByTheirShares) {
  const double turn = 0.021;  // the edge passes every share of a pixel
  Targets targets;
  targets.add(box_target({2.0, 2.0, 0.01}), {Vec3(-1.0, 0, 0.705), Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()))},
              {0.6, 0.0, 0.4});
  add_plate(targets, 0.75, 0.0, 0.6);
  const Shot shot = shoot(targets, {}, false);
  constexpr int fine = 24;
  double worst = 0.0, sum = 0.0;
  int crossed = 0;
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
    double signal = 0.0, depths = 0.0;
    int near = 0;
    for (int k = 0; k < fine * fine; ++k) {
      const Vec3 ray = shot.view.lens.ray(static_cast<double>(i % width) + (k % fine + 0.5) / fine - 0.5,
                                          static_cast<double>(i / width) + (k / fine + 0.5) / fine - 0.5);
      const bool on_near = (0.70 * ray.x() + 1.0) * std::cos(turn) + 0.70 * ray.y() * std::sin(turn) < 1.0;
      const double z = on_near ? 0.70 : 0.75;
      near += on_near;
      signal += 1.0 / (z * z);
      depths += 1.0 / z;
    }
    if (near == 0 || near == fine * fine) continue;
    const double off = std::abs(shot.measured.depth[i] - depths / signal);
    worst = std::max(worst, off);
    sum += off;
    ++crossed;
  }
  ASSERT_GT(crossed, 150);
  EXPECT_LT(worst, 0.008);
  EXPECT_LT(sum / crossed, 0.0025);
}

TEST(TimeOfFlight, DarkSurfacesDropOut) {
  Targets targets;
  add_plate(targets, 1.0, 0.0, 0.005);
  const Shot shot = shoot(targets, {}, true);
  EXPECT_EQ(static_cast<std::size_t>(
                std::count(shot.measured.validity.begin(), shot.measured.validity.end(), Validity::dark)),
            shot.view.depth.size());
}

}  // namespace
}  // namespace bin_scenes
