#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "sensor/models/line_peak.hpp"
#include "sensor/models/noise_field.hpp"
#include "sensor/models/time_of_flight_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

TEST(PredictedSigma, AnUnknownModelIsTakenForNoOther) {
  Sensor sensor;
  sensor.pose = Pose();
  sensor.model = "lidar";
  EXPECT_THROW(predicted_sigma(sensor, 1.0, 0.0, 0.5), Error);
}

TEST(CorrelatedNoise, HasUnitVarianceAndFallsWithTheWindow) {
  const int size = 600;
  for (const int window : {1, 5, 11}) {
    const std::vector<float> field = correlated_noise(size, size, window, Random(1, 0, Stream::noise));
    const auto correlation = [&](int lag) {
      double sum = 0.0;
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x + lag < size; ++x)
          sum += static_cast<double>(field[y * size + x]) * field[y * size + x + lag];
      }
      return sum / (static_cast<double>(size) * (size - lag));
    };
    const double variance = (window * window - 1.0) / 12.0;
    EXPECT_NEAR(correlation(0), 1.0, 0.06) << window;
    for (const int lag : {1, window / 2, window, 2 * window}) {
      const double expected = lag == 0 ? 1.0 : window == 1 ? 0.0 : std::exp(-lag * lag / (4.0 * variance));
      EXPECT_NEAR(correlation(lag), expected, 0.06) << window << " at " << lag;
    }
  }
}

TEST(CorrelatedNoise, IsTheSameAgain) {
  const Random random(3, 1, Stream::noise);
  EXPECT_EQ(correlated_noise(64, 48, 7, random), correlated_noise(64, 48, 7, random));
  EXPECT_NE(correlated_noise(64, 48, 7, random), correlated_noise(64, 48, 7, random.of_piece(1)));
}

std::vector<float> line(double row, double sigma, double height) {
  std::vector<float> signals(15);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const double x = (static_cast<double>(i) - row) / sigma;
    signals[i] = static_cast<float>(height * std::exp(-0.5 * x * x));
  }
  return signals;
}

TEST(LinePeak, IsFoundBetweenRows) {
  for (double row = 5.0; row < 9.0; row += 0.07) {
    const std::vector<float> signals = line(row, 1.2, 0.6);
    const auto peak = find_line(signals.data(), signals.size(), 1.2, 0.05);
    ASSERT_TRUE(peak);
    EXPECT_NEAR(peak->row, row, 1e-5);
  }
}

TEST(LinePeak, IsNotPulledByAnotherLine) {
  std::vector<float> signals = line(4.0, 0.8, 0.6);
  const std::vector<float> other = line(11.0, 0.8, 0.3);
  for (std::size_t i = 0; i < signals.size(); ++i) signals[i] += other[i];
  EXPECT_NEAR(find_line(signals.data(), signals.size(), 0.8, 0.05)->row, 4.0, 1e-5);
}

TEST(LinePeak, OfADarkSurfaceIsMissing) {
  const std::vector<float> signals = line(7.0, 1.0, 0.01);
  EXPECT_FALSE(find_line(signals.data(), signals.size(), 1.0, 0.02));
}

TEST(TimeOfFlightNoise, IsThatOfThePaper) {
  // Fankhauser et al. 2015, axial noise indoors, in mm. Rounding of the vertex of its parabola: below 0.001 mm.
  TimeOfFlightSettings s;
  for (const double z : {0.7, 1.0, 2.0, 3.0, 4.0}) {
    for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
      const double t = degrees * M_PI / 180.0, tilt = t / (0.5 * M_PI - t);
      const double paper = 1.5 - 0.5 * z + 0.3 * z * z + 0.1 * std::pow(z, 1.5) * tilt * tilt;
      EXPECT_NEAR(1e3 * axial_sigma(s, z, t, s.albedo), paper, 1e-3) << z << " m, " << degrees << " degrees";
    }
  }
  // Lateral noise of 1.6 mm, here in pixels of its camera (f = 365 pixels) at 1 m, whatever the incidence.
  EXPECT_NEAR(lateral_sigma(s, M_PI / 4), 1.6e-3 * 365.0, 5e-3);
  s.lateral_angle = 0.035;
  EXPECT_NEAR(lateral_sigma(s, M_PI / 4), s.lateral + 0.035, 1e-12);
  const double steep = 80.0 * M_PI / 180.0;
  EXPECT_EQ(axial_sigma(s, 1.0, 0.5 * M_PI, s.albedo), axial_sigma(s, 1.0, steep, s.albedo)) << "clamped at 80";
  EXPECT_LT(axial_sigma(s, 1.0, steep, s.albedo), 0.01);
  EXPECT_NEAR(axial_sigma(s, 1.0, 0.0, s.albedo / 4) / axial_sigma(s, 1.0, 0.0, s.albedo), 2.0, 1e-12);
}

}  // namespace
}  // namespace bin_scenes
