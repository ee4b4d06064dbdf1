/// The filters of disparities against closed forms: a plane, a ramp, steps, white noise, a unit.
#include "sensor/models/disparity_filters.hpp"

#include "bin_scenes/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace bin_scenes {
namespace {

constexpr int width = 201, height = 151;
constexpr double alpha = 0.6;

template <class Value>
std::vector<float> image(const Value& value) {
  std::vector<float> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out.push_back(static_cast<float>(value(x, y)));
  return out;
}
double at(const std::vector<float>& image, int x, int y) {
  return image[static_cast<std::size_t>(y) * width + x];
}
SpatialFilter filter_of(double delta, int iterations = 1) {
  return {alpha, delta, iterations};
}

TEST(SpatialFilter, APlaneKeepsItsDisparities) {
  const std::vector<float> level = image([](int, int) { return 42.25; });
  std::vector<float> filtered = level;
  filter_spatially(filter_of(1.0, 3), width, height, filtered);
  for (std::size_t i = 0; i < level.size(); ++i) ASSERT_NEAR(filtered[i], level[i], 1e-4);
  // Both directions draw a tilted plane by as much, far from the border.
  const auto tilted = [](int x, int y) { return 40.0 + 0.05 * x - 0.03 * y; };
  filtered = image(tilted);
  filter_spatially(filter_of(1.0, 2), width, height, filtered);
  for (int y = 40; y < height - 40; ++y)
    for (int x = 40; x < width - 40; ++x) ASSERT_NEAR(at(filtered, x, y), tilted(x, y), 1e-3);
}

TEST(SpatialFilter, ASmallStepBecomesTheSumOfTheKernel) {
  std::vector<float> filtered = image([](int x, int) { return x < 100 ? 40.0 : 40.5; });
  filter_spatially(filter_of(0.6), width, height, filtered);
  for (int k = 0; k < 20; ++k) {
    const double rest = std::pow(1.0 - alpha, k + 1) / (2.0 - alpha);  // what the kernel's tail holds beyond k
    ASSERT_NEAR(at(filtered, 100 + k, 75), 40.5 - 0.5 * rest, 1e-5) << k;
    ASSERT_NEAR(at(filtered, 99 - k, 75), 40.0 + 0.5 * rest, 1e-5) << k;
  }
}

TEST(SpatialFilter, AStepOfDeltaStays) {
  for (const bool along_rows : {false, true}) {
    const std::vector<float> steps =
        image([&](int x, int y) { return (along_rows ? x < 100 : y < 70) ? 40.0 : 40.75; });
    std::vector<float> filtered = steps;
    filter_spatially(filter_of(0.75, 3), width, height, filtered);
    for (std::size_t i = 0; i < steps.size(); ++i) ASSERT_NEAR(filtered[i], steps[i], 1e-4);
    filter_spatially(filter_of(0.76, 1), width, height, filtered);
    EXPECT_GT(std::abs(at(filtered, 100, 70) - at(steps, 100, 70)), 0.1);
  }
}

TEST(SpatialFilter, WhiteNoiseKeepsTheSquaresOfTheKernel) {
  Random random(1, 0, Stream::noise);
  std::vector<float> filtered(width * height);
  for (float& value : filtered) value = static_cast<float>(0.1 * random.normal());
  filter_spatially(filter_of(10.0), width, height, filtered);
  const double q = (1.0 - alpha) * (1.0 - alpha), peak = alpha / (2.0 - alpha);
  const double expected = peak * peak * (1.0 + q) / (1.0 - q);  // of the deviation: a variance for each dimension
  double square = 0.0;
  for (int y = 20; y < height - 20; ++y)
    for (int x = 20; x < width - 20; ++x) square += std::pow(at(filtered, x, y), 2);
  const double n = (width - 40.0) * (height - 40.0);
  EXPECT_NEAR(std::sqrt(square / n) / (0.1 * expected), 1.0, 0.025);  // 4 sigma of about 12000 independent pixels
  EXPECT_NEAR(spatially_filtered_noise(filter_of(10.0), 1.0), expected, 1e-9);
  EXPECT_EQ(spatially_filtered_noise(filter_of(10.0, 0), 1.0), 1.0);
  EXPECT_GT(spatially_filtered_noise(filter_of(10.0), 9.0), expected) << "what neighbours share stays";
}

TEST(SpatialFilter, HolesStayAndSeparate) {
  std::vector<float> filtered = image([](int x, int) {
    return x == 100 ? std::numeric_limits<double>::quiet_NaN() : x < 100 ? 40.0 : 40.5;
  });
  filter_spatially(filter_of(0.6, 2), width, height, filtered);
  for (int x = 0; x < width; ++x) {
    if (x == 100)
      ASSERT_TRUE(std::isnan(at(filtered, x, 75)));
    else
      ASSERT_NEAR(at(filtered, x, 75), x < 100 ? 40.0 : 40.5, 1e-4);
  }
}

TEST(DisparityStep, IsTheNearestMultiple) {
  EXPECT_EQ(rounded_to_step(40.33, 1.0 / 32.0), 40.34375);
  EXPECT_EQ(rounded_to_step(40.33, 0.25), 40.25);
  EXPECT_EQ(rounded_to_step(40.33, 0.0), 40.33);
}

}  // namespace
}  // namespace bin_scenes
