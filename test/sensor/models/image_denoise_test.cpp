#include "sensor/models/image_denoise.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "sensor/models/image_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

using namespace test;

struct Traced {
  std::vector<Rgb> radiance;
  std::vector<PathTracer::Grain> grain;
};

Traced traced(Targets& targets, const Sensor& sensor, int samples, std::uint64_t seed = 3) {
  const Scenery scenery = targets.scenery();
  const Lamps lamps = lamps_of(sensor);
  PathTracer::Setup setup;
  setup.samples = samples, setup.bounces = 1;
  const PathTracer tracer(scenery, lens_of(sensor), *sensor.pose, targets.surfaces(), lamps, setup,
                          Random(seed, 0, Stream::sensor));
  Traced out;
  const auto width = static_cast<std::size_t>(sensor.width);
  out.grain.resize(width * static_cast<std::size_t>(sensor.height));
  for (std::size_t row = 0; row < static_cast<std::size_t>(sensor.height); ++row)
    for (const Rgb& rgb : tracer.row(row, &out.grain[row * width])) out.radiance.push_back(rgb);
  return out;
}

std::vector<Rgb> denoised(Targets& targets, const Sensor& sensor, const Traced& image) {
  std::vector<Rgb> out = image.radiance;
  denoise(render(targets.scenery(), lens_of(sensor), *sensor.pose, sensor.near, sensor.far), image.grain, out);
  return out;
}

struct Moments {
  double mean, sigma;
};

Moments moments(const std::vector<Rgb>& radiance) {
  double sum = 0.0, square = 0.0;
  const auto n = static_cast<double>(radiance.size());
  for (const Rgb& rgb : radiance) sum += rgb.mean(), square += rgb.mean() * rgb.mean();
  return {sum / n, std::sqrt(std::max(square / n - sum * sum / n / n, 0.0))};
}

/// A lamp so wide that its points differ much, over a plate that is lit evenly.
ImageLamp wide_lamp() {
  ImageLamp lamp = flat(ImageLamp::Type::area, {0.0, 0.0, 0.2});
  lamp.width = lamp.height = 1.5;
  return lamp;
}

TEST(ImageDenoise, EvenLightKeepsItsMeanAndLosesItsGrain) {
  Targets targets = plate({0.7, 0.0, 0.4});
  const Sensor sensor = camera({wide_lamp()}, 64, 64, 0.05);
  const Traced image = traced(targets, sensor, 16);
  const Moments before = moments(image.radiance), after = moments(denoised(targets, sensor, image));
  EXPECT_GT(before.sigma, 0.01 * before.mean);  // or there is nothing to see
  EXPECT_LT(after.sigma, 0.25 * before.sigma);
  EXPECT_NEAR(after.mean, before.mean, 4.0 * before.sigma / 64.0);
}

/// Variance from two halves is that of independent paths: a sixteenth of the variance of images with one path. Points
/// that fill a square evenly err by less. The two paths of a pair have points in opposite halves of the square; thus
/// they differ more than independent ones, by up to 1.75 times in variance where light is linear in the point.
TEST(ImageDenoise, VarianceIsThatOfIndependentPaths) {
  Targets targets = plate({0.7, 0.0, 0.4});
  const Sensor sensor = camera({wide_lamp()}, 64, 64, 0.05);
  const Traced a = traced(targets, sensor, 16, 1), b = traced(targets, sensor, 16, 2);
  const Traced c = traced(targets, sensor, 1, 1), d = traced(targets, sensor, 1, 2);
  double told = 0.0, seen = 0.0, of_one = 0.0;
  for (std::size_t i = 0; i < a.radiance.size(); ++i) {
    told += static_cast<double>(a.grain[i].variance);
    seen += std::pow((a.radiance[i] - b.radiance[i]).mean(), 2) / 2.0;
    of_one += std::pow((c.radiance[i] - d.radiance[i]).mean(), 2) / 2.0;
  }
  EXPECT_GT(told, 0.9 * of_one / 16.0);
  EXPECT_LT(told, 1.8 * of_one / 16.0);
  EXPECT_GT(told, seen);
}

/// A bright and a dark plate in one plane, whose border runs through the middle of pixels: nothing spills over, and the
/// pixels of the border are half of each.
TEST(ImageDenoise, BordersBetweenPartsStaySharp) {
  Targets targets;
  targets.add(box_target({1.0, 1.0, 0.1}), {Vec3(0.5, 0.0, 1.05), Quat::Identity()}, {0.8, 0.0, 0.4});
  targets.add(box_target({1.0, 1.0, 0.1}), {Vec3(-0.5, 0.0, 1.05), Quat::Identity()}, {0.1, 0.0, 0.4});
  const Sensor sensor = camera({wide_lamp()}, 65, 64, 0.05);
  const Traced image = traced(targets, sensor, 16);
  const std::vector<Rgb> after = denoised(targets, sensor, image);
  for (std::size_t row = 0; row < 64; ++row) {
    const std::size_t middle = row * 65 + 32;
    EXPECT_FALSE(image.grain[middle].one_face());
    EXPECT_TRUE(image.grain[middle + 1].one_face());
    const double bright = after[row * 65 + 60][0], dark = after[row * 65 + 4][0];
    EXPECT_NEAR(after[middle][0], 0.5 * (bright + dark), 0.05 * bright) << row;
    EXPECT_NEAR(after[middle + 1][0] / bright, 1.0, 0.1) << row;
    EXPECT_NEAR(after[middle - 1][0] / dark, 1.0, 0.1) << row;
  }
}

double rms_of_difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) square += std::pow((a[i] - b[i]).mean(), 2);
  return std::sqrt(square / static_cast<double>(a.size()));
}

/// Facets of polished steel, about two pixels wide, of which each mirrors another part of the lamp: nearly all pixels
/// see two of them, and what lies beside a pixel says little about its light.
TEST(ImageDenoise, SmallFacetsThatMirrorKeepTheirLight) {
  Targets targets = plate({0.1, 0.05, 0.5}, 0.5);
  targets.add(ball_target(0.1, 4), {Vec3(0.0, 0.0, 0.9), Quat::Identity()}, {0.95, 0.95, 0.45, 2.9, 3.1});
  const Sensor sensor = camera({flat(ImageLamp::Type::area, {0.3, 0.1, 0.3}), dome(0.05)}, 48, 36, 0.4);
  const std::vector<Rgb> truth = traced(targets, sensor, 1024, 9).radiance;
  const Traced image = traced(targets, sensor, 64);
  EXPECT_LT(rms_of_difference(denoised(targets, sensor, image), truth),
            2.0 * rms_of_difference(image.radiance, truth));  // 2.3 if mixed light always replaces the pixel's own
}

/// Against an image of many samples: shadows, a round part, and a highlight.
TEST(ImageDenoise, ErrsByLessThanFourTimesTheSamples) {
  Targets targets = plate({0.6, 0.0, 0.4}, 0.5);
  targets.add(ball_target(0.06, 3), {Vec3(0.05, 0.03, 0.93), Quat::Identity()}, {0.9, 0.8, 0.4, 2.9, 3.1});
  targets.add(box_target({0.1, 0.1, 0.2}), {Vec3(-0.08, -0.06, 0.9), Quat(0.9, 0.3, 0.2, 0.1).normalized()},
              {0.7, 0.0, 0.4});
  ImageLamp lamp = flat(ImageLamp::Type::area, {0.3, 0.1, 0.3});
  const Sensor sensor = camera({lamp, dome(0.05)}, 96, 72, 0.4);
  const std::vector<Rgb> truth = traced(targets, sensor, 2048, 9).radiance;
  const auto error = [&](const std::vector<Rgb>& radiance) { return rms_of_difference(radiance, truth); };
  const Traced few = traced(targets, sensor, 4), more = traced(targets, sensor, 16);
  EXPECT_LT(error(denoised(targets, sensor, few)), error(more.radiance));
  EXPECT_LT(error(denoised(targets, sensor, more)), 0.6 * error(more.radiance));
}

TEST(ImageDenoise, NeedsSamples) {
  Sensor sensor = camera({});
  sensor.settings.of<ImageSettings>().denoise = true;
  EXPECT_NO_THROW(check_sensors({sensor}));
  sensor.settings.of<ImageSettings>().samples = 2;
  try {
    check_sensors({sensor});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where() + " " + error.problem(), "sensors[0].image.denoise needs at least 4 samples");
  }
}

}  // namespace
}  // namespace bin_scenes
