#include "sensor/models/exposure.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/in_parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace bin_scenes {

namespace {

/// The signal whose level this is.
double signal_of(double level) {
  return std::pow(level / 255.0, gray_gamma);
}

/// The scale from light to signals; 0 if nothing is lit.
double scale_for(std::vector<float> light) {
  double scale = std::numeric_limits<double>::infinity();
  const auto limit = [&](double share, double level) {
    const auto at = light.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(light.size() - 1));
    std::nth_element(light.begin(), at, light.end());
    if (*at > 0.0f) scale = std::min(scale, signal_of(level) / *at);
  };
  if (!light.empty()) {
    limit(0.5, median_level);
    limit(0.99, bright_level);
  }
  return std::isfinite(scale) ? scale : 0.0;
}

/// Levels of signals in equal steps from 0 to 1, so that a pixel needs no power.
class Levels {
 public:
  Levels() {
    for (std::size_t i = 0; i < table_.size(); ++i)
      table_[i] =
          static_cast<std::uint8_t>(std::lround(255.0 * std::pow(static_cast<double>(i) / last, 1.0 / gray_gamma)));
  }
  std::uint8_t of(float signal) const { return table_[static_cast<std::size_t>(last * signal + 0.5f)]; }

 private:
  static constexpr int last = 65535;
  std::array<std::uint8_t, last + 1> table_;
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
    for (std::size_t x = 0; x < columns; ++x) signals[x] *= static_cast<float>(scale);
    Random draw = random.of_piece(row);
    imager.expose(signals, columns, draw);
    for (std::size_t x = 0; x < columns; ++x) out[row * columns + x] = levels.of(signals[x]);
  });
  return out;
}

}  // namespace bin_scenes
