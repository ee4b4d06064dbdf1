#include "sensor/models/fringes.hpp"
#include "bin_scenes/core/error.hpp"
#include "sensor/models/imager.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

std::vector<float> seen(const Fringes& fringes, double column, double white = 0.5) {
  std::vector<float> images(fringes.images(), 0.0f);
  fringes.add_light(column, white, images.data());
  return images;
}

StructuredLightSettings steps_of(int steps) {
  StructuredLightSettings s;
  s.steps = steps;
  return s;
}

TEST(Fringes, EveryColumnIsReadBackAcrossTheWholeProjector) {
  for (const int width : {97, 640, 1280}) {
    for (const double period : {8.0, 16.0, 20.0, 36.0}) {
      StructuredLightSettings s;
      s.period = period;
      const Fringes fringes(s, width);
      for (double column = 0.0; column < width - 1; column += 0.37) {
        // What is left are 8-bit levels and the projector's pixels.
        ASSERT_NEAR(fringes.read(seen(fringes, column).data()).column, column, 2e-3 * period) << width << " " << period;
      }
    }
  }
}

TEST(Fringes, BlurNeverMakesAWrongPeriod) {
  StructuredLightSettings s;
  s.defocus = 1.5;
  const Fringes fringes(s, 1280);
  for (double column = 0.0; column < 1279.0; column += 0.01) {
    ASSERT_NEAR(fringes.read(seen(fringes, column).data()).column, column, 0.05);
  }
}

TEST(Fringes, AmplitudeIsWhatTheImagesShow) {
  for (const double defocus : {0.0, 0.7, 2.0}) {
    StructuredLightSettings s;
    s.defocus = defocus;
    const Fringes fringes(s, 1280);
    const double read = fringes.read(seen(fringes, 301.3, 1.0).data()).modulation;
    EXPECT_NEAR(read / fringes.amplitude(), 1.0, 0.01) << defocus;
  }
}

TEST(Fringes, LightOfManyPointsIsTheSumOfEach) {
  const Fringes fringes(StructuredLightSettings{}, 1280);
  const std::vector<float> columns{300.2f, 301.9f, 300.2f, 298.4f, -9.0f, 1300.0f},
      whites{0.1f, 0.3f, 0.05f, 0.2f, 0.1f, 0.1f};
  std::vector<float> each(fringes.images(), 0.0f), all = each;
  for (std::size_t k = 0; k < columns.size(); ++k) fringes.add_light(columns[k], whites[k], each.data());
  fringes.add_light(columns, whites, all.data());
  for (int n = 0; n < fringes.images(); ++n) EXPECT_NEAR(all[n], each[n], 1e-6) << n;
}

TEST(Fringes, AFootprintWeakensTheAmplitude) {
  const Fringes fringes(StructuredLightSettings{}, 1280);
  std::vector<float> images(fringes.images(), 0.0f);
  const double footprint = 5.0;
  for (int i = 0; i < 100; ++i) fringes.add_light(500.2 + ((i + 0.5) / 100 - 0.5) * footprint, 0.01, images.data());
  EXPECT_NEAR(fringes.read(images.data()).modulation, fringes.amplitude() * fringes.seen_through(footprint, 0.0, 0.0),
              2e-3);
}

TEST(Fringes, ACodeThatMakesNoSenseHasNoColumn) {
  const Fringes fringes(StructuredLightSettings{}, 1280);
  std::vector<float> images =
      seen(fringes, 600.0 + 7.5);  // the middle of a period: both readings of its number are sure
  ASSERT_FALSE(std::isnan(fringes.read(images.data()).column));
  for (std::size_t b = 8; b < images.size(); ++b) images[b] = 1.0f;  // white in all: half 170, beyond the projector
  EXPECT_TRUE(std::isnan(fringes.read(images.data()).column));
}

TEST(Fringes, TooFewGrayImagesForTheWidthAreRefused) {
  StructuredLightSettings s;
  s.gray_bits = 7;  // 64 periods
  EXPECT_NO_THROW(Fringes(s, 1024));
  try {
    Fringes(s, 1025);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "structured_light.gray_bits");
    EXPECT_NE(error.remedy().find("give 8"), std::string::npos) << error.what();
  }
}

/// Standard deviation of the columns read from noisy images, over that predicted.
double measured_over_predicted(int steps, double white, double column, const ImagerSettings& chip) {
  const Fringes fringes(steps_of(steps), 1280);
  const Imager imager(chip, true);
  Random random(1, 2, Stream::noise);
  const std::vector<float> clean = seen(fringes, column, white);
  const int n = 40000;
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < n; ++i) {
    std::vector<float> images = clean;
    imager.expose(images.data(), images.size(), random);
    const double error = fringes.read(images.data()).column - column;
    sum += error;
    square += error * error;
  }
  const double sigma = std::sqrt(square / n - (sum / n) * (sum / n));
  return sigma / fringes.column_sigma(std::sqrt(imager.variance(white * fringes.mean())), white * fringes.amplitude());
}

TEST(Fringes, NoiseIsThatOfTheFormula) {
  // 40,000 draws know a standard deviation within 0.35 %; five of those and the amplitude's 0.5 %.
  ImagerSettings chip;
  for (const int steps : {4, 8, 16}) {
    for (const double white : {0.02, 0.2, 0.8}) {
      EXPECT_NEAR(measured_over_predicted(steps, white, 411.7, chip), 1.0, 0.022) << steps << " " << white;
    }
  }
}

TEST(Imager, VarianceIsThatOfWhatItReads) {
  ImagerSettings chip;
  chip.bits = 10;
  const Imager imager(chip, true);
  Random random(0, 0, Stream::noise);
  for (const double signal : {0.01, 0.3, 0.9}) {
    const int n = 100000;
    std::vector<float> reads(n, static_cast<float>(signal));
    imager.expose(reads.data(), reads.size(), random);
    double sum = 0.0, square = 0.0;
    for (const float r : reads) {
      sum += r;
      square += static_cast<double>(r) * r;
    }
    const double variance = square / n - (sum / n) * (sum / n);
    EXPECT_NEAR(sum / n, signal, 5.0 * std::sqrt(imager.variance(signal) / n));
    EXPECT_NEAR(variance / imager.variance(signal), 1.0, 5.0 * std::sqrt(2.0 / n)) << signal;
  }
}

TEST(Imager, WithoutNoiseOnlyTheConverterIsLeft) {
  ImagerSettings chip;
  chip.bits = 8;
  Random random(0, 0, Stream::noise);
  float signals[] = {0.11f, 0.5f, 3.0f};
  Imager(chip, false).expose(signals, 3, random);
  EXPECT_NEAR(signals[0], 0.11, 0.5 / 255);
  EXPECT_EQ(signals[1] * 255.0f, std::round(signals[1] * 255.0f));
  EXPECT_TRUE(Imager(chip, false).saturated(signals[2]));
  EXPECT_FALSE(Imager(chip, false).saturated(signals[1]));
}

}  // namespace
}  // namespace bin_scenes
