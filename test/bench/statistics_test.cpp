#include "framework/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes::bench {
namespace {

TEST(Statistics, QuantilesBetweenSamples) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2.0);
  EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.95), 9.5);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.95), 7.0);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_DOUBLE_EQ(range({2, 5, 3}), 3.0);
}

TEST(Statistics, WassersteinOfShiftedSamplesIsTheShift) {
  EXPECT_DOUBLE_EQ(wasserstein({0, 1, 2}, {0.5, 1.5, 2.5}), 0.5);
  EXPECT_DOUBLE_EQ(wasserstein({2, 0, 1}, {0, 1, 2}), 0.0) << "order means nothing";
}

TEST(Statistics, WassersteinOfSamplesOfDifferentSize) {
  // {0, 1} twice over is the same distribution; one point against two costs the mean distance to them.
  EXPECT_DOUBLE_EQ(wasserstein({0, 1}, {0, 0, 1, 1}), 0.0);
  EXPECT_DOUBLE_EQ(wasserstein({0}, {1, 3}), 2.0);
  EXPECT_NEAR(wasserstein({0, 0, 3}, {0, 3}), 0.5, 1e-12) << "a sixth of the mass moves by 3";
}

TEST(Statistics, ExponentOfAPowerLaw) {
  std::vector<double> x, y;
  for (double n = 64; n <= 65536; n *= 4) {
    x.push_back(n);
    y.push_back(3e-4 * std::pow(n, 1.37));
  }
  EXPECT_NEAR(fitted_exponent(x, y), 1.37, 1e-12);
  EXPECT_TRUE(std::isnan(fitted_exponent({2, 2}, {1, 3})));
}

}  // namespace
}  // namespace bin_scenes::bench
