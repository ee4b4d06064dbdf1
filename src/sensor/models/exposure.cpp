#include "sensor/models/exposure.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/in_parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bin_scenes {

namespace {

/// The scale from light to signals; 0 if the median is not lit.
double scale_for(std::vector<float> light) {
  if (light.empty()) return 0.0;
  const auto median = light.begin() + static_cast<std::ptrdiff_t>((light.size() - 1) / 2);
  std::nth_element(light.begin(), median, light.end());
  return *median > 0.0f ? std::pow(median_level / 255.0, gray_gamma) / *median : 0.0;
}

/// Levels of signals. Those of signals from 0 to 1 are read from a table, so that a pixel needs no power.
class Levels {
 public:
  Levels() {
    for (std::size_t i = 0; i < table_.size(); ++i)
      table_[i] = static_cast<float>(255.0 * std::pow(static_cast<double>(i) / last, 1.0 / gray_gamma));
  }
  /// @param signal  reading of the exposure whose time is 2^-halvings
  std::uint8_t of(float signal, int halvings) const {
    float level = table_[static_cast<std::size_t>(last * signal + 0.5f)];
    if (halvings > 0) level *= std::exp2(static_cast<float>(halvings / gray_gamma));
    constexpr float knee = static_cast<float>(knee_level), rest = 255.0f - knee;
    if (level > knee) level = 255.0f - rest * rest / (level - knee + rest);
    return static_cast<std::uint8_t>(std::lround(level));
  }

 private:
  static constexpr int last = 65535;
  std::array<float, last + 1> table_;
};

}  // namespace

std::vector<std::uint8_t> exposed_for_parts(std::vector<float> light, const std::vector<std::uint16_t>& labels,
                                            int width, const Imager& imager, const Random& random) {
  BIN_SCENES_ASSERT(light.size() == labels.size());
  static const Levels levels;
  const auto scale_of = [&](const auto& counts) {
    std::vector<float> metered;
    for (std::size_t i = 0; i < light.size(); ++i) {
      if (counts(i)) metered.push_back(light[i]);
    }
    return scale_for(std::move(metered));
  };
  double scale = scale_of([&](std::size_t i) { return labels[i] != 0; });
  if (scale == 0.0) scale = scale_of([&](std::size_t i) { return light[i] > 0.0f; });
  std::vector<std::uint8_t> out(light.size());
  const auto columns = static_cast<std::size_t>(width);
  in_parallel(light.size() / columns, [&](std::size_t row) {
    float* const signals = &light[row * columns];
    std::vector<int> halvings(columns, 0);
    for (std::size_t x = 0; x < columns; ++x) {
      signals[x] *= static_cast<float>(scale);
      if (signals[x] >= 1.0f) signals[x] = std::frexp(signals[x], &halvings[x]);
    }
    Random draw = random.of_piece(row);
    imager.expose(signals, columns, draw);
    for (std::size_t x = 0; x < columns; ++x) out[row * columns + x] = levels.of(signals[x], halvings[x]);
  });
  return out;
}

}  // namespace bin_scenes
