/// The exposure of grey images by closed forms: of the parts' pixels, three fifths have one light, and the others are
/// brighter by a given factor.
#include "sensor/models/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

constexpr int width = 500, height = 200;

struct Pixels {
  std::vector<float> light;
  std::vector<std::uint16_t> labels;
};

Pixels pixels(double factor) {
  Pixels all;
  for (int i = 0; i < width * height; ++i) {
    all.light.push_back(static_cast<float>(i % 5 < 3 ? 0.003 : 0.003 * factor));
    all.labels.push_back(7);
  }
  return all;
}

std::vector<std::uint8_t> exposed(const Pixels& all, const ImagerSettings& settings, bool noise) {
  return exposed_for_parts(all.light, all.labels, width, Imager(settings, noise), Random(1, 0, Stream::noise));
}

/// The level without noise of what is `factor` times as bright as the median.
double level_of(double factor) {
  const double gamma = 120.0 * std::pow(factor, 1.0 / 2.2);
  return gamma <= 160.0 ? gamma : 255.0 - 95.0 * 95.0 / (gamma - 65.0);
}

ImagerSettings fine() {
  ImagerSettings settings;
  settings.bits = 16;
  settings.read_noise = 0.0;
  return settings;
}

TEST(Exposure, TheMedianHasItsLevelAndHighlightsBendAtTheKnee) {
  for (const double factor : {1.0, 1.5, 2.0, 5.0, 5.3, 30.0, 500.0, 5000.0}) {
    const std::vector<std::uint8_t> levels = exposed(pixels(factor), fine(), false);
    EXPECT_EQ(levels[0], 120) << factor;
    EXPECT_NEAR(levels[4], level_of(factor), 0.51) << factor;
  }
}

/// Shot noise of the exposure from which a pixel is read: its time is the half, the quarter, ... of the longest.
TEST(Exposure, NoiseIsThatOfTheExposureOfAPixel) {
  ImagerSettings settings = fine();
  settings.full_well = 1000.0;
  for (const double factor : {1.0, 3.0, 6.0, 25.0}) {
    const std::vector<std::uint8_t> levels = exposed(pixels(factor), settings, true);
    const double signal = std::pow(120.0 / 255.0, 2.2) * factor;
    const double time = signal < 1.0 ? 1.0 : std::exp2(-std::floor(std::log2(signal)) - 1.0);
    const double step = 1e-3,
                 slope = (level_of(factor * (1.0 + step)) - level_of(factor * (1.0 - step))) / (2.0 * step);
    const double expected = slope * slope / (signal * time * 1000.0) + 1.0 / 12.0;  // levels are rounded
    double sum = 0.0, square = 0.0, count = 0.0;
    for (std::size_t i = 3; i < levels.size(); i += i % 5 == 3 ? 1 : 4) {
      sum += levels[i], square += static_cast<double>(levels[i]) * levels[i], ++count;
    }
    const double mean = sum / count;
    EXPECT_NEAR((square / count - mean * mean) / expected, 1.0, 0.06) << factor;  // 3 sigma of the count: 0.02
    EXPECT_NEAR(mean, level_of(factor), 0.3) << factor;
  }
}

/// Where less than half of the parts' pixels are lit, all lit pixels count.
TEST(Exposure, PartsInTheDarkDoNotDetermineIt) {
  Pixels all = pixels(1.0);
  for (int i = 0; i < width * height; ++i) {
    if (i % 5 < 3) all.light[static_cast<std::size_t>(i)] = 0.0f;
  }
  const std::vector<std::uint8_t> levels = exposed(all, fine(), false);
  EXPECT_EQ(levels[0], 0);
  EXPECT_EQ(levels[4], 120);
}

TEST(Exposure, UnlitPixelsAreBlack) {
  const std::vector<std::uint8_t> levels = exposed(pixels(0.0), fine(), false);
  EXPECT_EQ(levels[4], 0);
}

}  // namespace
}  // namespace bin_scenes
