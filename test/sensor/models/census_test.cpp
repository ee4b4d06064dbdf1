/// The census matcher on images of known disparity: random grey levels, shifted.
#include "sensor/models/census.hpp"

#include "bin_scenes/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace bin_scenes {
namespace {

constexpr int width = 240, height = 96, least = 5;

/// Smooth random texture, by place in the first image.
class Texture {
 public:
  explicit Texture(std::uint64_t seed) {
    Random random(seed, 0, Stream::noise);
    for (double& v : values_) v = random.uniform();
  }
  /// Linear between grid points 3 pixels apart, as dots that a camera sees larger than its pixels.
  double at(double x, int y) const {
    const double u = (x + 200.0) / 3.0, v = y / 3.0;
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const double s = u - i, t = v - j;
    return (1 - t) * ((1 - s) * grid(i, j) + s * grid(i + 1, j)) +
           t * ((1 - s) * grid(i, j + 1) + s * grid(i + 1, j + 1));
  }

 private:
  double grid(int i, int j) const { return values_[static_cast<std::size_t>(j) * columns + i]; }
  static constexpr int columns = 240;
  std::vector<double> values_ = std::vector<double>(static_cast<std::size_t>(columns) * 40);
};

/// Images of a surface whose disparity depends on the column of the second image, so that none hides another.
Stereo::Pair pair_of(const std::function<double(double, int)>& disparity) {
  const Texture texture(3);
  Stereo::Pair pair;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      pair.first.push_back(static_cast<std::uint8_t>(std::lround(20.0 + 200.0 * texture.at(x, y))));
      pair.second.push_back(static_cast<std::uint8_t>(
          std::lround(10.0 + 100.0 * texture.at(x + disparity(x, y), y))));  // a darker camera
    }
  }
  return pair;
}

struct Case {
  StereoSettings settings;
  StereoPipeline pipeline;
  Case() {
    settings.window = 9;
    settings.disparities = 64;
    pipeline.matcher = StereoMatcher::census;
  }
  std::vector<float> match(const Stereo::Pair& pair) const {
    return match_census(pair, width, height, settings, pipeline, least);
  }
};

TEST(Census, FindsWholeDisparitiesExactlyWhateverTheGain) {
  for (const int census : {3, 5, 7, 9}) {
    Case c;
    c.pipeline.census = census;
    for (const int d : {7, 20, 63}) {
      const std::vector<float> found = c.match(pair_of([d](double, int) { return d; }));
      std::size_t right = 0, all = 0;
      for (int y = 0; y < height; ++y)
        for (int x = d + 12; x < width - 12; ++x, ++all)
          right += std::abs(found[static_cast<std::size_t>(y) * width + x] - d) < 0.26;
      EXPECT_GT(static_cast<double>(right), 0.995 * static_cast<double>(all)) << census << " " << d;
    }
  }
}

TEST(Census, FindsFractions) {
  const Case c;
  for (const double d : {20.25, 20.5, 20.75}) {
    const std::vector<float> found = c.match(pair_of([d](double, int) { return d; }));
    double sum = 0.0, square = 0.0, n = 0.0;
    for (int y = 8; y < height - 8; ++y) {
      for (int x = 40; x < width - 12; ++x) {
        const double e = found[static_cast<std::size_t>(y) * width + x] - d;
        if (std::isnan(e)) continue;
        sum += e, square += e * e, n += 1.0;
      }
    }
    EXPECT_LT(std::abs(sum / n), 0.05) << d;
    EXPECT_LT(std::sqrt(square / n), 0.12) << d;
  }
}

/// A step along y hides nothing. Rows near it have a window of both surfaces.
struct Edge {
  double missing = 0.0;  ///< rows, mean over columns
  double wide = 0.0;     ///< rows with 10 to 90 % of the step
};
Edge edge_of(const Case& c, double step) {
  const std::vector<float> found = c.match(pair_of([&](double, int y) { return y < 48 ? 20.0 : 20.0 + step; }));
  double missing = 0.0, wide = 0.0, columns = 0.0;
  for (int x = 60; x < width - 20; ++x, columns += 1.0) {
    for (int y = 30; y < 66; ++y) {
      const double share = (found[static_cast<std::size_t>(y) * width + x] - 20.0) / step;
      missing += std::isnan(share);
      wide += share > 0.1 && share < 0.9;
    }
  }
  return {missing / columns, wide / columns};
}

TEST(Census, ALargeStepOpensAGapAsWideAsTheSecondPeakSays) {
  Case c;
  for (const double second_peak : {0.0, 0.05, 0.1}) {
    c.pipeline.second_peak = second_peak;
    const Edge edge = edge_of(c, 8.0);
    // Half of the bits of a wrong disparity differ, fewer of the best of 64 wrong ones.
    const double least_gap = 2.0 * second_peak * c.settings.window;
    EXPECT_GT(edge.missing, least_gap - 0.7) << second_peak;
    EXPECT_LT(edge.missing, 2.0 * least_gap + 0.7) << second_peak;
    EXPECT_LT(edge.wide, 1.0) << second_peak;
  }
}

TEST(Census, ASmallStepIsBlendedOverTheWindow) {
  Case c;
  for (const int window : {7, 13}) {
    c.settings.window = window;
    const Edge edge = edge_of(c, 1.0);
    EXPECT_LT(edge.missing, 0.1) << window;
    EXPECT_NEAR(edge.wide, 0.8 * window, 0.3 * window) << window;  // 80 % of a ramp over the window
  }
}

TEST(Census, WithoutTextureOrBeyondTheSecondImageNothingIsMatched) {
  const Case c;
  Stereo::Pair plain{std::vector<std::uint8_t>(width * height, 80), std::vector<std::uint8_t>(width * height, 80)};
  const std::vector<float> none = c.match(plain);
  const int first = least + 4 + c.settings.window;  // further left the second image has no rivals of a disparity
  for (int y = 0; y < height; ++y)
    for (int x = first; x < width; ++x) ASSERT_TRUE(std::isnan(none[static_cast<std::size_t>(y) * width + x])) << x;
  const std::vector<float> found = c.match(pair_of([](double, int) { return 40.0; }));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 40; ++x) {  // no disparity that leads beyond the border is reported
      const float d = found[static_cast<std::size_t>(y) * width + x];
      ASSERT_TRUE(std::isnan(d) || d <= static_cast<float>(x) + 0.5f) << x;
    }
  }
}

/// Rows of an image that are computed in two bands are those of an image that ends elsewhere.
TEST(Census, BandsDoNotCount) {
  const Case c;
  const Stereo::Pair whole = pair_of([](double x, int y) { return 20.0 + 0.02 * x + 0.01 * y; });
  constexpr int cut = 20;
  const Stereo::Pair lower{{whole.first.begin() + cut * width, whole.first.end()},
                           {whole.second.begin() + cut * width, whole.second.end()}};
  const std::vector<float> all = c.match(whole);
  const std::vector<float> part = match_census(lower, width, height - cut, c.settings, c.pipeline, least);
  const int rim = c.settings.window / 2 + c.pipeline.census / 2;
  for (int y = cut + rim; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float a = all[static_cast<std::size_t>(y) * width + x];
      const float b = part[static_cast<std::size_t>(y - cut) * width + x];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace bin_scenes
