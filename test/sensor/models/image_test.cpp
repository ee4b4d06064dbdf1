#include "sensor/models/image.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "light/unit_circle.hpp"
#include "sensor/models/image_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

using namespace test;

/// A closed box in which lamps shine from all six walls: L after n bounces is the sum of a^k, k = 0 .. n + 1, with the
/// lamps' own light, which a camera inside sees.
TEST(Image, WhiteFurnace) {
  const Vec3 size(0.3, 0.2, 0.1);
  std::vector<ImageLamp> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 middle = Vec3::Zero();
      middle[axis] = side * (0.5 * size[axis] - 1e-4);
      ImageLamp lamp =
          flat(ImageLamp::Type::area, middle, Quat::FromTwoVectors(Vec3::UnitZ(), -side * Vec3::Unit(axis)));
      lamp.width = lamp.height = 0.5;  // beyond the edges: there they lie outside the box
      walls.push_back(lamp);
    }
  }
  for (const double albedo : {1.0, 0.5}) {
    Mesh box = box_target(size);
    for (Triangle& t : box.triangles) std::swap(t[1], t[2]);
    Targets targets;
    targets.add(box, Pose(), {albedo, 0.0, 0.4});
    // A lamp within a tenth of a millimetre of what it lights is found by rays.
    double closed_form = 1.0 + albedo;
    for (int bounces = 0; bounces <= 2; ++bounces, closed_form += std::pow(albedo, bounces + 1)) {
      const Mean seen = radiance(targets, camera(walls), 16, bounces, By::lobe);
      EXPECT_NEAR(seen.value, closed_form, 0.01 * closed_form) << albedo << " " << bounces;
    }
  }
}

/// Under an even dome whatever is alone sends back its albedo times the dome's radiance.
TEST(Image, PlateUnderADome) {
  for (const double albedo : {0.25, 1.0}) {
    Targets matte = plate({albedo, 0.0, 0.4});
    EXPECT_NEAR(radiance(matte, camera({dome(2.0)}), 16, 2).value, 2.0 * albedo, 1e-12);
  }
  for (const double roughness : {0.2, 0.6}) {
    Targets shiny = plate({0.8, 1.0, roughness});
    EXPECT_NEAR(radiance(shiny, camera({dome(1.0)}), 256, 2).value, 0.8, 0.008) << roughness;
  }
}

/// Of a parallel rectangle seen from below its corner, four of them make one seen from below its middle (Howell,
/// "A catalog of radiation heat transfer configuration factors", B-4).
double rectangle_factor(double width, double height, double distance) {
  const double a = 0.5 * width / distance, b = 0.5 * height / distance, p = std::sqrt(1.0 + a * a),
               q = std::sqrt(1.0 + b * b);
  return 4.0 / (2.0 * M_PI) * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
}

/// L = albedo / pi * E, E = pi * radiance * factor; by points, by rays and by both.
TEST(Image, RectangleAndDiskOverAPlate) {
  ImageLamp area = flat(ImageLamp::Type::area, {0.0, 0.0, 0.6});
  area.width = 0.5, area.height = 0.2;
  area.radiance = 3.0;
  ImageLamp disk = flat(ImageLamp::Type::ring, {0.0, 0.0, 0.6});
  disk.outer = 0.3, disk.inner = 0.0;
  ImageLamp ring = disk;
  ring.inner = 0.2;
  const auto disk_factor = [](double r, double h) { return r * r / (r * r + h * h); };
  const std::vector<std::pair<ImageLamp, double>> cases = {{area, 3.0 * rectangle_factor(0.5, 0.2, 0.4)},
                                                           {disk, disk_factor(0.3, 0.4)},
                                                           {ring, disk_factor(0.3, 0.4) - disk_factor(0.2, 0.4)}};
  for (const auto& [lamp, factor] : cases) {
    for (const By by : {By::both, By::lamps, By::lobe}) {
      Targets targets = plate({0.6, 0.0, 0.4});
      const Mean seen = radiance(targets, camera({lamp}, 9, 9, 0.002), 256, 0, by);
      EXPECT_NEAR(seen.value, 0.6 * factor, 4.0 * seen.error + 2e-4 * factor) << static_cast<int>(by);
      EXPECT_LT(seen.error, 0.005 * factor);
    }
  }
}

/// The projector's light falls with the square of the distance, and ends at its field's edge.
TEST(Image, ProjectorOverAPlate) {
  ImageLamp lamp;
  lamp.type = ImageLamp::Type::projector;
  lamp.radiance = 2.0;
  Sensor sensor = camera({lamp});
  sensor.projector.pose = Pose{Vec3(0.0, 0.0, -1.0), Quat::Identity()};
  Targets targets = plate({0.5, 0.0, 0.4});
  EXPECT_NEAR(radiance(targets, sensor, 4, 0).value, 0.5 * 2.0 / 4.0, 1e-3);
  sensor.projector.pose->orientation = Quat(Eigen::AngleAxisd(1.0, Vec3::UnitX()));
  EXPECT_EQ(radiance(targets, sensor, 4, 0).value, 0.0);
}

/// Points on lamps and rays of the lobe estimate one number; both together do so with less error than either.
TEST(Image, WaysToFindLampsAgree) {
  ImageLamp area = flat(ImageLamp::Type::area, {0.2, 0.0, 0.3});
  area.width = area.height = 0.2;
  for (const double roughness : {0.2, 0.5}) {
    for (const bool metal : {false, true}) {
      Surface surface{0.9, 0.9, roughness};
      if (metal) surface.refraction = 2.9, surface.extinction = 3.1;
      Targets targets = plate(surface, 0.6);
      targets.add(box_target({0.1, 0.1, 0.2}), {Vec3(0.25, 0.1, 0.9), Quat::Identity()}, surface);
      const Sensor sensor = camera({area}, 40, 40, 0.4);
      const Scenery scenery = targets.scenery();
      const Lamps lamps = lamps_of(sensor);
      std::vector<std::vector<double>> pixels(3);
      for (const By by : {By::both, By::lamps, By::lobe}) {
        PathTracer::Setup setup;
        setup.samples = 64, setup.bounces = 2, setup.by = by;
        const PathTracer tracer(scenery, lens_of(sensor), *sensor.pose, targets.surfaces(), lamps, setup,
                                Random(static_cast<std::uint64_t>(by), 1, Stream::sensor));
        for (std::size_t row = 0; row < 40; ++row)
          for (const Rgb& rgb : tracer.row(row)) pixels[static_cast<std::size_t>(by)].push_back(rgb[0]);
      }
      // Means differ by what the pixels' own differences, which are independent, say.
      for (const std::size_t other : {1u, 2u}) {
        double sum = 0.0, square = 0.0;
        const auto n = static_cast<double>(pixels[0].size());
        for (std::size_t i = 0; i < pixels[0].size(); ++i) {
          const double d = pixels[0][i] - pixels[other][i];
          sum += d, square += d * d;
        }
        const double error = std::sqrt(square / n - sum * sum / n / n) / std::sqrt(n);
        EXPECT_LT(std::abs(sum / n), 4.0 * error) << other << " " << roughness << " " << metal;
        double mean = 0.0;
        for (const double p : pixels[0]) mean += p / n;
        EXPECT_LT(error, 0.05 * mean);  // or it could not fail
      }
    }
  }
}

/// Which lamp a path asks says nothing about where on it: two halves of a lamp leave as much noise as the whole.
TEST(Image, HalvesOfALampLeaveTheNoiseOfTheWhole) {
  const auto lamp = [](double middle, double width) {
    ImageLamp area = flat(ImageLamp::Type::area, {middle, 0.0, 0.6});
    area.width = width, area.height = 1.0;
    return area;
  };
  Targets targets = plate({0.6, 0.0, 0.4});
  const Mean whole = radiance(targets, camera({lamp(0.0, 1.0)}, 32, 32), 64, 0, By::lamps);
  const Mean halves = radiance(targets, camera({lamp(-0.25, 0.5), lamp(0.25, 0.5)}, 32, 32), 64, 0, By::lamps);
  EXPECT_NEAR(halves.value, whole.value, 0.01 * whole.value);
  EXPECT_LT(halves.error, 1.2 * whole.error);
}

/// A lens that distorts by nothing to speak of has its first hits by rays.
TEST(Image, WhatIsDrawnIsWhatRaysMeet) {
  Targets targets = plate({0.7, 0.3, 0.3}, 0.5);
  targets.add(ball_target(0.1, 3), {Vec3(0.02, 0.03, 0.9), Quat::Identity()}, {0.9, 0.0, 0.4});
  targets.add(box_target({0.1, 0.1, 0.2}), {Vec3(-0.12, -0.1, 0.9), Quat(0.9, 0.3, 0.2, 0.1).normalized()});
  const Sensor sensor = camera({dome(0.5), flat(ImageLamp::Type::ring, Vec3::Zero())}, 64, 48, 0.4);
  const Scenery scenery = targets.scenery();
  const Lamps lamps = lamps_of(sensor);
  Lens drawn = lens_of(sensor), cast = drawn;
  cast.distortion[0] = 1e-13;
  for (const double blur : {0.0, 0.8}) {
    PathTracer::Setup setup;
    setup.blur = blur;
    const auto tracer = [&](const Lens& lens) {
      return PathTracer(scenery, lens, *sensor.pose, targets.surfaces(), lamps, setup, Random(5, 0, Stream::sensor));
    };
    const PathTracer a = tracer(drawn), b = tracer(cast);
    for (std::size_t row = 0; row < 48; ++row) {
      const std::vector<Rgb> x = a.row(row), y = b.row(row);
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i][0], y[i][0], 1e-7 * y[i][0]) << row << " " << i;
    }
  }
}

TEST(Image, PointsOfTheUnitCircle) {
  for (int i = 0; i <= 100000; ++i) {
    const double share = i * 1e-5;
    const Eigen::Vector2d at = on_unit_circle(share);
    ASSERT_NEAR(at.x(), std::cos(2.0 * M_PI * share), 1e-15) << share;
    ASSERT_NEAR(at.y(), std::sin(2.0 * M_PI * share), 1e-15) << share;
  }
}

TEST(Image, ExposureNoiseAndRepeatability) {
  Sensor sensor = camera({dome(7.0)}, 64, 48, 0.2);
  sensor.imager.exposure = 0.6;
  sensor.settings.of<ImageSettings>().bits = 16;
  Targets targets = plate({0.5, 0.0, 0.4});
  const Scenery scenery = targets.scenery();
  const auto taken = [&](const Sensor& s, std::uint64_t seed) {
    return measure(scenery, render(scenery, lens_of(s), *s.pose, s.near, s.far), s, targets.surfaces(), {seed, 4, 0});
  };
  // A white plate would give 0.6.
  const RangeImage image = taken(sensor, 1);
  ASSERT_EQ(image.picture.channels, 1);
  ASSERT_EQ(image.picture.counts.size(), 64u * 48u);
  double sum = 0.0, square = 0.0;
  for (const std::uint16_t count : image.picture.counts)
    sum += count / 65535.0, square += count / 65535.0 * count / 65535.0;
  const double n = 64 * 48, mean = sum / n, sigma = std::sqrt(square / n - mean * mean);
  const double expected = std::sqrt(0.3 / 1e4 + 25e-8 + 1.0 / (12.0 * 4095.0 * 4095.0));
  EXPECT_NEAR(mean, 0.3, 5.0 * expected / std::sqrt(n));
  EXPECT_NEAR(sigma, expected, 4.0 * expected / std::sqrt(2.0 * n));
  EXPECT_NEAR(image.snr[100], 0.3 / expected, 0.01 * 0.3 / expected);
  EXPECT_FLOAT_EQ(image.depth[100], 1.0f);
  EXPECT_EQ(taken(sensor, 1).picture.counts, image.picture.counts);
  EXPECT_NE(taken(sensor, 2).picture.counts, image.picture.counts);
  sensor.noise = false;
  for (const std::uint16_t count : taken(sensor, 1).picture.counts) EXPECT_NEAR(count / 65535.0, 0.3, 1.0 / 4095.0);
}

/// A matte red plate sends back red, its highlight has the lamp's colour; a metal mirrors its own.
TEST(Image, Colours) {
  Sensor sensor = camera({dome(1.0)});
  sensor.settings.of<ImageSettings>().colour = true;
  sensor.noise = false;
  const auto ratio = [&](const Surface& surface) {
    Targets targets = plate(surface);
    const Scenery scenery = targets.scenery();
    const RangeImage image =
        measure(scenery, render(scenery, lens_of(sensor), *sensor.pose, 0.01, 10.0), sensor, targets.surfaces(), {});
    EXPECT_EQ(image.picture.channels, 3);
    return static_cast<double>(image.picture.counts[3 * 40 + 1]) / image.picture.counts[3 * 40];
  };
  Surface red{0.9, 0.0, 0.4};
  red.colour = Vec3(1.0, 0.5, 0.2);
  EXPECT_NEAR(ratio(red), 0.5, 0.01);
  red.gloss = 0.5;
  EXPECT_NEAR(ratio(red), (0.5 * 0.5 + 0.5) / 1.0, 0.05);
  red.refraction = 0.2, red.extinction = 3.0;
  EXPECT_NEAR(ratio(red), 0.5, 0.05);
}

TEST(Image, RefusesWhatMakesNoSense) {
  const auto problem = [](const Sensor& sensor) -> std::string {
    try {
      check_sensors({sensor});
    } catch (const Error& error) {
      return error.where() + ": " + error.problem();
    }
    return "";
  };
  Sensor sensor = camera({});
  EXPECT_EQ(problem(sensor), "");
  auto& settings = sensor.settings.of<ImageSettings>();
  settings.samples = 12;
  EXPECT_EQ(problem(sensor), "sensors[0].image.samples: 12 is not a power of two");
  settings.samples = 16384, sensor.width = 1280, sensor.height = 976;
  EXPECT_NE(problem(sensor).find("20 billion paths"), std::string::npos) << problem(sensor);
  settings.samples = 16, settings.bits = 12;
  EXPECT_EQ(problem(sensor), "sensors[0].image.bits: is 12");
  settings.bits = 8;
  settings.lamps = {flat(ImageLamp::Type::ring, Vec3::Zero())};
  settings.lamps[0].inner = 0.1;
  EXPECT_EQ(problem(sensor), "sensors[0].lamps[0].inner: is not below the outer radius");
}

}  // namespace
}  // namespace bin_scenes
