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
  // Nguyen et al. 2012, equation 2 at 10 degrees or less, and their figure 5's growth towards grazing.
  TimeOfFlightSettings s;
  EXPECT_NEAR(axial_sigma(s, 1.0, 0.0, s.albedo), 0.0012 + 0.0019 * 0.36, 1e-12);
  EXPECT_NEAR(axial_sigma(s, 2.0, 0.0, s.albedo), 0.0012 + 0.0019 * 2.56, 1e-12);
  EXPECT_NEAR(axial_sigma(s, 1.0, M_PI / 3, s.albedo) - axial_sigma(s, 1.0, 0.0, s.albedo), 0.0001 * 4.0, 1e-12);
  EXPECT_NEAR(lateral_sigma(s, M_PI / 4), 0.8 + 0.035, 1e-12);
  const double steep = 80.0 * M_PI / 180.0;
  EXPECT_EQ(axial_sigma(s, 1.0, 0.5 * M_PI, s.albedo), axial_sigma(s, 1.0, steep, s.albedo)) << "measured up to 80";
  EXPECT_LT(axial_sigma(s, 1.0, steep, s.albedo), 0.01);
  EXPECT_NEAR(axial_sigma(s, 1.0, 0.0, s.albedo / 4) / axial_sigma(s, 1.0, 0.0, s.albedo), 2.0, 1e-12);
}

}  // namespace
}  // namespace bin_scenes
