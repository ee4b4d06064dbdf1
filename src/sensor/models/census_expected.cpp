#include "sensor/models/census_expected.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/noise_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace bin_scenes {

namespace {

// Fitted to match_census() on images of heaps (docs/lab/realism.md).
constexpr float blended = 3.2f;     // pixel: surfaces this far apart do not move each other's disparity
constexpr float separate = 2.5f;    // pixel: from here on they are rivals
constexpr double rivals = 0.38;     // share of a window by which the best of all wrong disparities fits
constexpr double by_chance = 0.31;  // fluctuation of the margin of a window with one dot; of spread dots as well
constexpr std::uint64_t behind_all_rows = 1u << 20;  // piece of random numbers that the field of noise does not use
constexpr double false_matches = 0.06;  // share of the pixels far from any match at which a wrong disparity wins

/// Whether none of the 3 x 3 pixels has a disparity. Next to a match, the test of left and right rejects wrong ones.
bool far_from_matches(const std::vector<float>& disparities, int width, int height, int column, int row) {
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, height - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, width - 1); ++x) {
      if (!std::isnan(disparities[static_cast<std::size_t>(y) * width + x])) return false;
    }
  }
  return true;
}

}  // namespace

ExpectedCensus::ExpectedCensus(const StereoSettings& settings, const StereoPipeline& pipeline, double pitch)
    // A signature sees as far as half of its window.
    : reach_((settings.window + pipeline.census / 2) / 2),
      // Half of the bits of a wrong disparity differ.
      least_(rivals + 2.0 * pipeline.second_peak) {
  const double edge = 2.0 * reach_ + 1.0, dots = settings.dots * pitch * pitch * edge * edge;
  fluctuation_ = by_chance / std::sqrt(dots > 0.0 ? dots : edge * edge);  // without dots each pixel is texture
}

ExpectedCensus::Match ExpectedCensus::match_of(const std::vector<float>& disparities, int width, int height, int column,
                                               int row) const {
  const int left = std::max(column - reach_, 0), right = std::min(column + reach_, width - 1);
  const int top = std::max(row - reach_, 0), bottom = std::min(row + reach_, height - 1);
  const auto at = [&](int x, int y) { return disparities[static_cast<std::size_t>(y) * width + x]; };
  float mean = at(column, row);
  int agree = 0, differ = 0;
  for (int step = 0; step < 2; ++step) {
    float weights = 0.0f, sum = 0.0f;
    agree = differ = 0;
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const float other = at(x, y), off = std::abs(other - mean);
        const float weight = off < blended ? 1.0f - off * off / (blended * blended) : 0.0f;  // NaN is not near
        weights += weight;
        sum += weight > 0.0f ? weight * other : 0.0f;
        agree += off <= separate;
        differ += off > separate;
      }
    }
    mean = sum / weights;  // its own pixel counts until the mean has left it
  }
  const int pixels = (right - left + 1) * (bottom - top + 1);
  return {mean, static_cast<float>(agree - differ) / static_cast<float>(pixels)};
}

float ExpectedCensus::false_match(const std::vector<float>& disparities, int width, int height, int column, int row,
                                  double share) const {
  float least = std::numeric_limits<float>::infinity(), most = -least;
  for (int y = std::max(row - reach_, 0); y <= std::min(row + reach_, height - 1); ++y) {
    for (int x = std::max(column - reach_, 0); x <= std::min(column + reach_, width - 1); ++x) {
      const float disparity = disparities[static_cast<std::size_t>(y) * width + x];
      if (std::isnan(disparity)) continue;
      least = std::min(least, disparity);
      most = std::max(most, disparity);
    }
  }
  return least + static_cast<float>(share) * (most - least);
}

void ExpectedCensus::match(int width, int height, const Random& random, std::vector<float>& disparities) const {
  const std::vector<float> field = correlated_noise(width, height, (2.0 * reach_ + 2.0) / 3.0, random);
  const std::vector<float> truth = disparities;
  in_parallel(static_cast<std::size_t>(height), [&](std::size_t row) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (std::isnan(truth[i])) continue;
      const Match match = match_of(truth, width, height, x, static_cast<int>(row));
      const bool wins = match.margin + fluctuation_ * field[i] > least_;
      disparities[i] = wins ? match.disparity : std::numeric_limits<float>::quiet_NaN();
    }
  });
  const std::vector<float> matches = disparities;
  in_parallel(static_cast<std::size_t>(height), [&](std::size_t row) {
    Random own = random.of_piece(behind_all_rows).of_piece(row);
    for (int x = 0; x < width; ++x) {
      const std::size_t i = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const int y = static_cast<int>(row);
      const bool wrong = own.uniform() < false_matches;
      const double share = own.uniform();
      if (!wrong || std::isnan(truth[i]) || !far_from_matches(matches, width, height, x, y)) continue;
      disparities[i] = false_match(truth, width, height, x, y, share);
    }
  });
}

}  // namespace bin_scenes
