/// The filters of disparities against closed forms: a plane, a ramp, steps, white noise, a unit.
#include "sensor/models/disparity_filters.hpp"

#include "bin_scenes/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
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

constexpr float none = std::numeric_limits<float>::quiet_NaN();

TEST(TemporalAverage, WhiteNoiseHasTheVarianceOfAnExponentialAverage) {
  for (const int frames : {1, 2, 5, 30}) {
    TemporalFilter settings;
    settings.frames = frames;
    settings.delta = 100.0;
    TemporalAverage average(settings);
    Random random(2, 0, Stream::noise);
    std::vector<float> pixels(40000);
    for (int frame = 0; frame < frames; ++frame) {
      for (float& value : pixels) value = static_cast<float>(50.0 + 0.1 * random.normal());
      average.add(pixels);
    }
    double square = 0.0;
    for (const float value : pixels) square += std::pow(value - 50.0, 2);
    // The sum of squared weights: alpha (1 - alpha)^k of the image k before the last one, (1 - alpha)^(n - 1) of the
    // first.
    double expected = std::pow(1.0 - settings.alpha, 2 * (frames - 1));
    for (int k = 0; k + 1 < frames; ++k) expected += std::pow(settings.alpha * std::pow(1.0 - settings.alpha, k), 2);
    EXPECT_NEAR(std::sqrt(square / 40000.0) / 0.1, std::sqrt(expected), 0.015 * std::sqrt(expected))
        << frames;  // 4 sigma
    EXPECT_NEAR(temporally_filtered_noise(settings), std::sqrt(expected), 1e-12);
  }
  TemporalFilter many;
  many.frames = 200;
  EXPECT_NEAR(std::pow(temporally_filtered_noise(many), 2), 0.4 / 1.6, 1e-9) << "alpha / (2 - alpha)";
}

TEST(TemporalAverage, ARampLagsAndAStepOfDeltaStartsAgain) {
  TemporalAverage average({1, 0.4, 0.6, Persistence::off});
  std::vector<float> pixel(1);
  for (int frame = 0; frame < 60; ++frame) {
    pixel = {40.0f + 0.1f * static_cast<float>(frame)};
    average.add(pixel);
  }
  // It lags by the slope times (1 - alpha) / alpha.
  EXPECT_NEAR(pixel[0], 40.0 + 5.9 - 0.1 * 0.6 / 0.4, 1e-4);
  const double lagging = pixel[0];
  pixel = {static_cast<float>(lagging + 0.59)};
  average.add(pixel);
  EXPECT_NEAR(pixel[0], lagging + 0.4 * 0.59, 1e-5);
  const double before = pixel[0];
  pixel = {static_cast<float>(before + 0.61)};
  average.add(pixel);
  EXPECT_NEAR(pixel[0], before + 0.61, 1e-5);
}

/// For each image whether the pixel has a value after the filter: measured where the text has an x.
std::string persistent(Persistence persistence, const std::string& measured) {
  TemporalAverage average({1, 0.4, 0.6, persistence});
  std::string shown;
  for (const char image : measured) {
    std::vector<float> pixel{image == 'x' ? 40.0f : none};
    average.add(pixel);
    shown += std::isnan(pixel[0]) ? '.' : 'x';
  }
  return shown;
}

TEST(TemporalAverage, PersistenceCountsTheImagesBefore) {
  EXPECT_EQ(persistent(Persistence::off, "xx.xxxxxxxxx."), "xx.xxxxxxxxx.");
  EXPECT_EQ(persistent(Persistence::eight_of_eight, "xxxxxxx.xxxxxxxx.."), "xxxxxxx.xxxxxxxxx.");
  EXPECT_EQ(persistent(Persistence::two_of_three, "x.x..x.."), "x.xx.x..");
  EXPECT_EQ(persistent(Persistence::two_of_four, "x.x..x..."), "x.xxxxx..");
  EXPECT_EQ(persistent(Persistence::two_of_eight, "x......x...."), "x......xx...");
  EXPECT_EQ(persistent(Persistence::one_of_two, ".x...x.."), ".xxx.xxx");
  EXPECT_EQ(persistent(Persistence::one_of_five, "x......."), "xxxxxx..");
  EXPECT_EQ(persistent(Persistence::one_of_eight, "x.........."), "xxxxxxxxx..");
  EXPECT_EQ(persistent(Persistence::always, "..x.........."), "..xxxxxxxxxxx");
}

TEST(HoleFilling, TakesTheNeighbourThatItNames) {
  //                              farther, a hole, nearer: smaller disparities are farther away
  const std::vector<float> image{10.0f, none,  30.0f,  //
                                 20.0f, none,  none,   //
                                 40.0f, 50.0f, 60.0f};
  const auto filled = [&](HoleFilling filling) {
    std::vector<float> out = image;
    fill_holes(filling, 3, 3, out);
    return out;
  };
  const std::vector<float> off = filled(HoleFilling::off);
  EXPECT_TRUE(std::isnan(off[1]) && std::isnan(off[4]) && std::isnan(off[5]));
  EXPECT_EQ(filled(HoleFilling::left), (std::vector<float>{10, 10, 30, 20, 20, 20, 40, 50, 60}));
  EXPECT_EQ(filled(HoleFilling::farthest), (std::vector<float>{10, 10, 30, 20, 10, 10, 40, 50, 60}));
  EXPECT_EQ(filled(HoleFilling::nearest), (std::vector<float>{10, 20, 30, 20, 50, 60, 40, 50, 60}));
  std::vector<float> empty(9, none);
  fill_holes(HoleFilling::nearest, 3, 3, empty);
  for (const float value : empty) EXPECT_TRUE(std::isnan(value));
}

TEST(Decimation, IsTheMedianOfDepthsAndFrom4OnTheirMean) {
  // The depths 1 / d of the first square are 0.5, 0.25, 0.125 and 0.1; of the two in the middle 0.125 is the smaller
  // one.
  EXPECT_EQ(decimated(2, 5, 3,
                      {2, 4, 5, none, 7,      //
                       8, 10, none, none, 7,  //
                       1, 1, 1, 1, 1}),
            (std::vector<float>{8, 5}));
  EXPECT_EQ(decimated(2, 2, 2, {none, 4, 5, 6}), (std::vector<float>{5}));
  EXPECT_TRUE(std::isnan(decimated(2, 2, 2, {none, none, none, none})[0]));
  std::vector<float> square(16, 2.0f);
  square[3] = none;
  for (int k = 8; k < 16; ++k) square[static_cast<std::size_t>(k)] = 4.0f;
  EXPECT_NEAR(decimated(4, 4, 4, square)[0], 15.0 / (7.0 / 2.0 + 8.0 / 4.0), 1e-6);
}

TEST(Decimation, LowersWhiteNoiseAsAMedianAndAMeanDo) {
  Random random(3, 0, Stream::noise);
  std::vector<float> noisy(width * height);
  for (float& value : noisy) value = static_cast<float>(100.0 + 0.1 * random.normal());
  const auto deviation = [&](int factor) {
    double square = 0.0, sum = 0.0;
    const std::vector<float> out = decimated(factor, width, height, noisy);
    for (const float value : out) square += std::pow(value - 100.0, 2), sum += value - 100.0;
    const double n = static_cast<double>(out.size());
    return std::sqrt(square / n - std::pow(sum / n, 2)) / 0.1;
  };
  EXPECT_NEAR(deviation(3), 0.4083, 0.017);  // median of nine normal variables: variance 0.1661 (Teichroew 1956)
  EXPECT_NEAR(deviation(4), 0.25, 0.017);    // mean of sixteen; 4 sigma of 1850 and more squares
}

TEST(DisparityStep, IsTheNearestMultiple) {
  EXPECT_EQ(rounded_to_step(40.33, 1.0 / 32.0), 40.34375);
  EXPECT_EQ(rounded_to_step(40.33, 0.25), 40.25);
  EXPECT_EQ(rounded_to_step(40.33, 0.0), 40.33);
}

}  // namespace
}  // namespace bin_scenes
