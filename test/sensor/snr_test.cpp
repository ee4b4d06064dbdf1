/// The SNR that images state against the noise of repeated images: mean squares of n errors over their predicted
/// variance are 1 within standard_errors * sqrt(2 / n).
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/triangulation.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

constexpr double standard_errors = 4.0;

Sensor device(const std::string& model) {
  Sensor sensor;
  sensor.model = model;
  sensor.width = 161;  // the laser's line lies in the middle of a column
  sensor.height = 120;
  sensor.fov = 0.4;
  sensor.near = 0.5;
  sensor.far = 2.0;
  sensor.pose = Pose();
  sensor.bounces = 0;
  Bin nothing;
  nothing.kind = Bin::Kind::none;
  return resolved(sensor, nothing);
}

/// A plate of two albedos at z = 1 that fills the left two thirds of the view; beside it there is nothing.
std::vector<RangeImage> shots(const Sensor& sensor, std::size_t count) {
  Targets targets;
  targets.add(box_target({2.0, 2.0, 0.02}), {Vec3(-0.95, -1.0, 1.01), Quat::Identity()}, {0.8, 0.0, 0.4});
  targets.add(box_target({2.0, 2.0, 0.02}), {Vec3(-0.95, 1.0, 1.01), Quat::Identity()}, {0.3, 0.0, 0.4});
  const Scenery scenery = targets.scenery();
  std::vector<RangeImage> images;
  for (std::size_t k = 0; k < count; ++k) {
    images.push_back(measure(scenery, render(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far), sensor,
                             targets.surfaces(), {1, k, 0}));
  }
  return images;
}

struct Squares {
  double sum = 0.0;
  std::size_t n = 0;
  void expect_one(const std::string& what) const {
    ASSERT_GT(n, 1000u) << what;
    EXPECT_NEAR(sum / static_cast<double>(n), 1.0, standard_errors * std::sqrt(2.0 / static_cast<double>(n))) << what;
  }
};

/// @param sigma  of the depth by pixel and SNR
template <class Sigma>
Squares squares_of_depth(const std::vector<RangeImage>& images, std::size_t step, const Sigma& sigma) {
  Squares squares;
  for (const RangeImage& image : images) {
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t y = step / 2; y < static_cast<std::size_t>(image.height); y += step) {
      if (y > 55 && y < 65) continue;  // the border of the albedos
      for (std::size_t x = step / 2; x < width; x += step) {
        const std::size_t i = y * width + x;
        EXPECT_EQ(image.snr[i] > 0.0f, image.validity[i] == 0);
        if (image.validity[i] != 0 || x > 80) continue;  // mixed pixels lie at the plate's end
        squares.sum += std::pow((image.depth[i] - 1.0) / sigma(x, y, image.snr[i]), 2);
        ++squares.n;
      }
    }
  }
  return squares;
}

TEST(Snr, OfFringesIsThatOfTheirPhase) {
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    Sensor sensor = device("structured_light");
    sensor.fidelity = fidelity;
    const Triangulation triangle(lens_of(sensor.projector), *sensor.projector.pose);
    const double turn = 2.0 * M_PI / sensor.settings.of<StructuredLightSettings>().period;
    squares_of_depth(shots(sensor, 8), 3, [&](std::size_t x, std::size_t y, double snr) {
      const Vec3 ray = lens_of(sensor).ray(static_cast<double>(x), static_cast<double>(y));
      return triangle.depth_per_column(ray, 1.0) / (turn * snr);
    }).expect_one(fidelity == Fidelity::analytic ? "analytic" : "decoded");
  }
}

TEST(Snr, OfTimeOfFlightIsDepthOverItsNoise) {
  squares_of_depth(shots(device("time_of_flight"), 8), 3, [](std::size_t, std::size_t, double snr) {
    return 1.0 / snr;
  }).expect_one("time of flight");
}

TEST(Snr, OfStereoIsThatOfTheGreyValue) {
  Sensor sensor = device("stereo");
  sensor.projector.width = 200, sensor.projector.height = 150;  // made anew for each image
  const auto& s = sensor.settings.of<StereoSettings>();
  const double full = std::sqrt(Imager(sensor.imager, true).variance(1.0)), scale = lens_of(sensor).fx * s.baseline;
  // Pixels so far apart that their windows share nothing.
  squares_of_depth(shots(sensor, 200), 14, [&](std::size_t, std::size_t, double snr) {
    return std::hypot(s.disparity_noise / (full * snr), 1.0 / 16.0 / std::sqrt(12.0)) / scale;
  }).expect_one("analytic");
}

/// Variance of the intensity over `images` by pixel against (mean / SNR)^2.
Squares squares_of_intensity(const std::vector<std::vector<double>>& intensities,
                             const std::vector<std::vector<double>>& snrs) {
  Squares squares;
  for (std::size_t i = 0; i < intensities.size(); ++i) {
    if (intensities[i].size() < 2) continue;
    double mean = 0.0, variance = 0.0;
    const auto n = static_cast<double>(intensities[i].size());
    for (std::size_t k = 0; k < intensities[i].size(); ++k) {
      mean += intensities[i][k] / n;
      variance += std::pow(intensities[i][k] / snrs[i][k], 2) / n;
    }
    for (const double intensity : intensities[i]) squares.sum += std::pow(intensity - mean, 2) / variance;
    squares.n += intensities[i].size() - 1;
  }
  return squares;
}

TEST(Snr, OfDecodedStereoIsThatOfTheGreyValueRead) {
  Sensor sensor = device("stereo");
  sensor.fidelity = Fidelity::decoded;
  const std::vector<RangeImage> images = shots(sensor, 24);
  std::vector<std::vector<double>> intensities(images[0].depth.size()), snrs = intensities;
  for (const RangeImage& image : images) {
    for (std::size_t i = 0; i < image.depth.size(); i += 7) {
      EXPECT_EQ(image.snr[i] > 0.0f, image.validity[i] == 0);
      if (image.validity[i] != 0) continue;
      intensities[i].push_back(image.intensity[i]);
      snrs[i].push_back(image.snr[i]);
    }
  }
  squares_of_intensity(intensities, snrs).expect_one("decoded");
}

TEST(Snr, OfALaserLineIsThatOfItsPeak) {
  Sensor sensor = device("laser_line");
  sensor.scan.profiles = 300;
  sensor.scan.step = 1e-6;
  sensor.scan.direction = -Vec3::UnitX();
  sensor.settings.of<LaserLineSettings>().blur = 0.4;  // one pixel has nearly all of the line's light
  const RangeImage image = shots(sensor, 1).front();
  std::vector<std::vector<double>> intensities(static_cast<std::size_t>(image.width)), snrs = intensities;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    EXPECT_EQ(image.snr[i] > 0.0f, image.validity[i] == 0);
    if (image.validity[i] != 0) continue;
    intensities[i % intensities.size()].push_back(image.intensity[i]);
    snrs[i % intensities.size()].push_back(image.snr[i]);
  }
  squares_of_intensity(intensities, snrs).expect_one("laser line");
}

TEST(Snr, OfAnExactSensorHasNoBound) {
  const RangeImage image = shots(device("ideal"), 1).front();
  std::size_t missing = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    ASSERT_EQ(image.snr[i], std::isnan(image.depth[i]) ? 0.0f : std::numeric_limits<float>::infinity());
    missing += std::isnan(image.depth[i]);
  }
  EXPECT_GT(missing, 1000u);
}

TEST(Snr, WithoutNoiseIsTheSame) {
  for (const char* model : {"structured_light", "stereo", "time_of_flight"}) {
    Sensor sensor = device(model);
    const RangeImage noisy = shots(sensor, 1).front();
    sensor.noise = false;
    const RangeImage quiet = shots(sensor, 1).front();
    for (std::size_t i = 0; i < noisy.snr.size(); i += 11) {
      const std::size_t row = i / 161;
      if (i % 161 > 80 || (row > 55 && row < 65) || noisy.snr[i] == 0.0f) continue;
      ASSERT_NEAR(quiet.snr[i], noisy.snr[i], 1e-3 * noisy.snr[i]) << model;  // rays of a time of flight jitter
    }
  }
}

}  // namespace
}  // namespace bin_scenes
