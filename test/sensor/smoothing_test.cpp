#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "sensor/fit.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace bin_scenes {
namespace {

constexpr double noise = 1e-4;  // m
const Lens lens = Lens::from_fov(400, 300, 0.4);

/// Depth along each ray; of NaN there is nothing.
RangeImage image_of(const std::function<double(const Vec3&)>& depth, double sigma, std::uint64_t seed = 1) {
  RangeImage image;
  image.width = lens.width;
  image.height = lens.height;
  Random random(seed, 0, Stream::noise);
  for (int y = 0; y < lens.height; ++y) {
    for (int x = 0; x < lens.width; ++x) {
      image.depth.push_back(static_cast<float>(depth(lens.ray(x, y)) + sigma * random.normal()));
      image.snr.push_back(10.0f);
      image.label.push_back(1);
    }
  }
  return image;
}

/// A plate through (0, 0, 1), turned about y.
std::function<double(const Vec3&)> plate(double degrees) {
  const double slope = std::tan(degrees * M_PI / 180.0);
  return [slope](const Vec3& ray) { return 1.0 / (1.0 - slope * ray.x()); };
}

RangeImage smoothed(RangeImage image, double sigma, double step = 0.005) {
  FilterSettings settings;
  settings.smoothing = {sigma, step};
  image.validity.clear();
  for (const float z : image.depth)
    image.validity.push_back(static_cast<std::uint8_t>(std::isnan(z) ? Validity::nothing : Validity::valid));
  filter(settings, image);
  return image;
}

/// Of the pixels whose whole window lies in the image.
struct Errors {
  double mean = 0.0, rms = 0.0;
};
Errors errors(const RangeImage& image, const std::function<double(const Vec3&)>& depth) {
  constexpr int margin = 12;
  Errors out;
  double count = 0.0;
  for (int y = margin; y < image.height - margin; ++y) {
    for (int x = margin; x < image.width - margin; ++x) {
      const double e = image.depth[static_cast<std::size_t>(y) * image.width + x] - depth(lens.ray(x, y));
      out.mean += e, out.rms += e * e, count += 1.0;
    }
  }
  out.mean /= count;
  out.rms = std::sqrt(out.rms / count);
  return out;
}

/// sqrt(sum w^2) of normally distributed weights whose sum is 1.
double factor(double sigma) {
  return 1.0 / (2.0 * std::sqrt(M_PI) * sigma);
}

TEST(Smoothing, WhiteNoiseFallsByTheKernelsFactorWhateverTheTilt) {
  for (const double degrees : {0.0, 60.0}) {
    const RangeImage raw = image_of(plate(degrees), noise);
    for (const double sigma : {1.0, 2.0, 4.0}) {
      const Errors e = errors(smoothed(raw, sigma), plate(degrees));
      // Means of so many pixels are one independent number.
      const double numbers = 376.0 * 276.0 / (4.0 * M_PI * sigma * sigma);
      EXPECT_NEAR(e.rms / (factor(sigma) * noise), 1.0, 0.05) << degrees << " degrees, sigma " << sigma;
      EXPECT_LT(std::abs(e.mean), 4.0 * e.rms / std::sqrt(numbers)) << degrees << " degrees, sigma " << sigma;
    }
  }
}

TEST(Smoothing, ATiltedPlateStaysWhereItIs) {
  for (const double degrees : {0.0, 60.0, 75.0}) {
    const RangeImage exact = image_of(plate(degrees), 0.0), after = smoothed(exact, 2.0);
    const double standard_error = noise / std::sqrt(376.0 * 276.0);
    EXPECT_LT(std::abs(errors(after, plate(degrees)).mean), 0.1 * standard_error) << degrees;
    // At the image's border, where windows are cut, as well.
    for (std::size_t i = 0; i < exact.depth.size(); ++i) ASSERT_NEAR(after.depth[i], exact.depth[i], 2e-7) << i;
  }
}

TEST(Smoothing, AStepStaysSharp) {
  // Both sides are tilted: a step in depth that the slope alone would not tell.
  const auto step = [](const Vec3& ray) { return plate(40.0)(ray) + (ray.x() > 0.013 ? 0.05 : 0.0); };
  const RangeImage exact = image_of(step, 0.0), still = smoothed(exact, 2.0);
  for (std::size_t i = 0; i < exact.depth.size(); ++i) ASSERT_NEAR(still.depth[i], exact.depth[i], 1e-5) << i;

  const RangeImage raw = image_of(step, noise), after = smoothed(raw, 2.0);
  std::vector<double> before_at(lens.width), after_at(lens.width);  // sum of squares by column
  for (int y = 0; y < lens.height; ++y) {
    for (int x = 0; x < lens.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * lens.width + x;
      ASSERT_LT(std::abs(after.depth[i] - raw.depth[i]), 5.0 * noise) << x << ' ' << y;
      before_at[x] += std::pow(raw.depth[i] - exact.depth[i], 2);
      after_at[x] += std::pow(after.depth[i] - exact.depth[i], 2);
    }
  }
  for (int x = 0; x < lens.width; ++x) EXPECT_LT(std::sqrt(after_at[x] / before_at[x]), 0.5) << x;
}

TEST(Smoothing, ABallShrinksByItsCurvatureAlone) {
  // The mean of a surface's second derivatives: along its normal s^2 / 2R (1 + 1 / cos^2) at an angle to the line of
  // sight, s being sigma in metres.
  const double radius = 0.05, sigma = 2.0;
  const auto ball = [&](const Vec3& ray) {
    const double a = ray.squaredNorm(), b = ray.z(), c = 1.0 - radius * radius, root = b * b - a * c;
    return root > 0.0 ? (b - std::sqrt(root)) / a : std::numeric_limits<double>::quiet_NaN();
  };
  const RangeImage after = smoothed(image_of(ball, 0.0), sigma);
  std::vector<Vec3> points, expected_points;
  for (int y = 0; y < lens.height; ++y) {
    for (int x = 0; x < lens.width; ++x) {
      const Vec3 ray = lens.ray(x, y), at = ball(ray) * ray, normal = (at - Vec3::UnitZ()) / radius;
      const double facing = -normal.dot(ray.normalized());
      if (!(facing > std::cos(0.8))) continue;
      const double depth = after.depth[static_cast<std::size_t>(y) * lens.width + x];
      const double inwards = (depth - ball(ray)) * ray.norm() * facing, s = sigma * ball(ray) / lens.fx;
      const double expected = 0.5 * s * s / radius * (1.0 + 1.0 / (facing * facing));
      ASSERT_NEAR(inwards / expected, 1.0, 0.25) << x << ' ' << y;
      points.push_back(depth * ray);
      expected_points.push_back(at - expected * normal);
    }
  }
  const double shrunk = radius - fit_ball(points).radius, s = sigma * 0.95 / lens.fx;
  EXPECT_NEAR(shrunk / (radius - fit_ball(expected_points).radius), 1.0, 0.15);
  EXPECT_LT(shrunk, 3.0 * s * s / radius);
}

TEST(Smoothing, InvalidPixelsGiveAndTakeNothing) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  RangeImage image = image_of(plate(60.0), 0.0);
  Random random(3, 0, Stream::noise);
  for (float& z : image.depth)
    if (random.uniform() < 0.5) z = nan;
  const RangeImage after = smoothed(image, 2.0);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    ASSERT_EQ(std::isnan(after.depth[i]), std::isnan(image.depth[i])) << i;
    if (std::isnan(image.depth[i])) continue;
    ASSERT_NEAR(after.depth[i], image.depth[i], 2e-7) << i;
  }
  // One alone stays.
  std::fill(image.depth.begin(), image.depth.end(), nan);
  image.depth[5000] = 1.25f;
  EXPECT_EQ(smoothed(image, 2.0).depth[5000], 1.25f);
}

TEST(Smoothing, OffKeepsAllBits) {
  const RangeImage raw = image_of(plate(30.0), noise);
  EXPECT_EQ(smoothed(raw, 0.0).depth, raw.depth);
  EXPECT_NE(smoothed(raw, 0.5).depth, raw.depth);
}

TEST(Smoothing, ComesAfterTheOtherFiltersAndLeavesTheSnr) {
  RangeImage image = image_of(plate(0.0), 0.0);
  const std::size_t out = 150 * 400 + 200;
  image.depth[out] = 1.004f;  // within the step, and dark
  image.snr[out] = 1.0f;
  image.validity.assign(image.depth.size(), 0);
  FilterSettings settings;
  settings.smoothing = {2.0, 0.005};
  RangeImage pulled = image;
  filter(settings, pulled);
  EXPECT_GT(pulled.depth[out + 1], 1.00001f);
  settings.snr = 5.0;
  filter(settings, image);
  EXPECT_NEAR(image.depth[out + 1], 1.0f, 1e-7);
  EXPECT_EQ(image.snr[out + 1], 10.0f);
}

TEST(Smoothing, IsTheSameForAnyNumberOfThreads) {
  const RangeImage raw = image_of(plate(60.0), noise);
  const RangeImage many = smoothed(raw, 2.0);
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(smoothed(raw, 2.0).depth, many.depth);
}

TEST(Smoothing, MistakesAreTold) {
  const auto error = [](const SmoothingFilter& smoothing, const char* model = "structured_light") -> std::string {
    Sensor sensor;
    sensor.model = model;
    sensor.settings.of<FilterSettings>().smoothing = smoothing;
    try {
      check_sensors({sensor});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error({2.0, 0.005}), "");
  EXPECT_NE(error({-1.0, 0.005}).find("sensors[0].filter.smoothing.sigma"), std::string::npos);
  EXPECT_NE(error({2.0, 0.0}).find("sensors[0].filter.smoothing.step"), std::string::npos);
  EXPECT_EQ(error({0.0, 0.005}, "laser_line"), "");
  const std::string profiles = error({2.0, 0.005}, "laser_line");
  EXPECT_NE(profiles.find("sensors[0].filter.smoothing"), std::string::npos);
  EXPECT_NE(profiles.find("laser_line"), std::string::npos);
}

}  // namespace
}  // namespace bin_scenes
