/// The formula of the census matcher on a plane, small and large steps, and borders of what can be matched.
#include "sensor/models/census_expected.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bin_scenes {
namespace {

constexpr int width = 120, height = 60, edge = 60;

template <class Value>
std::vector<float> image(const Value& value) {
  std::vector<float> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out.push_back(static_cast<float>(value(x, y)));
  return out;
}

/// A window of 9 pixels and signatures of 5: 11 pixels in all.
ExpectedCensus matcher(double second_peak = 0.02, double dots = 0.1) {
  StereoSettings settings;
  settings.window = 9;
  settings.dots = dots;
  StereoPipeline pipeline;
  pipeline.census = 5;
  pipeline.second_peak = second_peak;
  return ExpectedCensus(settings, pipeline, 0.3);
}
constexpr int reach = 5, window = 11;

TEST(ExpectedCensus, APlaneIsItsOwnMean) {
  const auto plane = [](int x, int y) { return 40.0 + 0.05 * x - 0.03 * y; };
  const std::vector<float> truth = image(plane);
  for (int y = reach; y < height - reach; ++y) {
    for (int x = reach; x < width - reach; ++x) {
      const ExpectedCensus::Match match = matcher().match_of(truth, width, height, x, y);
      ASSERT_NEAR(match.disparity, plane(x, y), 1e-3);
      ASSERT_EQ(match.margin, 1.0f);
    }
  }
}

TEST(ExpectedCensus, ASmallStepIsARampOverTheWindow) {
  const std::vector<float> truth = image([](int x, int) { return x < edge ? 40.0 : 40.4; });
  for (int x = edge - 10; x < edge + 10; ++x) {
    const ExpectedCensus::Match match = matcher().match_of(truth, width, height, x, 30);
    const double beyond = std::clamp((x + reach - edge + 1) / double(window), 0.0, 1.0);
    ASSERT_NEAR(match.disparity, 40.0 + 0.4 * beyond, 0.01) << x;  // weights differ by 1 % over 0.4 of 4 pixels
    ASSERT_EQ(match.margin, 1.0f);
  }
}

TEST(ExpectedCensus, ALargeStepIsSharpAndLosesMargin) {
  const std::vector<float> truth = image([](int x, int) { return x < edge ? 40.0 : 48.0; });
  for (int k = 0; k < 10; ++k) {
    const ExpectedCensus::Match match = matcher().match_of(truth, width, height, edge + k, 30);
    EXPECT_EQ(match.disparity, 48.0f);
    EXPECT_NEAR(match.margin, std::min(1.0, (2.0 * k + 1.0) / window), 1e-6) << k;
  }
}

TEST(ExpectedCensus, TheGapGrowsWithTheSecondPeak) {
  const std::vector<float> truth = image([](int x, int) { return x < edge ? 40.0 : 48.0; });
  const auto gap = [&](double second_peak) {
    std::vector<float> found = truth;
    matcher(second_peak, 0.9).match(width, height, Random(1, 0, Stream::noise), found);
    double missing = 0.0;
    for (int y = 0; y < height; ++y)
      for (int x = edge - window; x < edge + window; ++x)
        missing += std::isnan(found[static_cast<std::size_t>(y) * width + x]);
    return missing / height;
  };
  // The margin grows by 2 / 11 a pixel, and the threshold is 0.38 + 2 * second_peak.
  EXPECT_NEAR(gap(0.02), 0.42 * window, 0.7);
  EXPECT_NEAR(gap(0.22), 0.82 * window, 0.7);
}

TEST(ExpectedCensus, FalseMatchesAreBetweenTheSurfacesAndFarFromMatches) {
  const std::vector<float> truth = image([](int x, int) { return x < edge ? 40.0 : 48.0; });
  int places = 0, wrong = 0;
  double sum = 0.0;
  for (int seed = 0; seed < 20; ++seed) {
    std::vector<float> found = truth;
    matcher(0.22, 0.9).match(width, height, Random(seed, 0, Stream::noise), found);
    const auto at = [&](int x, int y) { return found[static_cast<std::size_t>(y) * width + x]; };
    const auto is_match = [&](int x, int y) { return at(x, y) == 40.0f || at(x, y) == 48.0f; };
    for (int y = 1; y < height - 1; ++y) {
      for (int x = edge - window; x < edge + window; ++x) {
        bool near = false;
        for (int v = -1; v <= 1; ++v)
          for (int u = -1; u <= 1; ++u) near = near || is_match(x + u, y + v);
        const bool is_wrong = !std::isnan(at(x, y)) && !is_match(x, y);
        ASSERT_FALSE(near && is_wrong);
        places += !near;
        wrong += is_wrong;
        if (!is_wrong) continue;
        ASSERT_GT(at(x, y), 40.0f);
        ASSERT_LT(at(x, y), 48.0f);
        sum += at(x, y);
      }
    }
  }
  // Binomial, and the mean of a uniform distribution: each within four standard deviations, odds of 1 in 16,000.
  ASSERT_GT(places, 5000);
  EXPECT_NEAR(wrong, 0.06 * places, 4.0 * std::sqrt(0.06 * 0.94 * places));
  EXPECT_NEAR(sum / wrong, 44.0, 4.0 * 8.0 / std::sqrt(12.0 * wrong));
}

TEST(ExpectedCensus, FewDotsLeaveHoles) {
  const std::vector<float> truth = image([](int, int) { return 40.0; });
  const auto missing = [&](double dots) {
    std::vector<float> found = truth;
    matcher(0.02, dots).match(width, height, Random(1, 0, Stream::noise), found);
    double count = 0.0;
    for (const float d : found) count += std::isnan(d);
    return count / (width * height);
  };
  EXPECT_LT(missing(0.5), 1e-3);
  EXPECT_GT(missing(0.05), 5e-3);
  EXPECT_GT(missing(0.02), 2.0 * missing(0.05));
}

TEST(ExpectedCensus, WhatCannotBeMatchedStaysMissingAndCountsForNothing) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> truth = image([](int x, int) { return x < edge ? 40.0f : nan; });
  EXPECT_NEAR(matcher().match_of(truth, width, height, edge - 1, 30).margin, 6.0 / 11.0, 1e-6);
  std::vector<float> found = truth;
  matcher(0.02, 0.9).match(width, height, Random(1, 0, Stream::noise), found);
  for (int y = 0; y < height; ++y)
    for (int x = edge; x < width; ++x) ASSERT_TRUE(std::isnan(found[static_cast<std::size_t>(y) * width + x]));
}

}  // namespace
}  // namespace bin_scenes
