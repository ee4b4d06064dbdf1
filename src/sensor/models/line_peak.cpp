#include "sensor/models/line_peak.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

std::optional<LinePeak> find_line(const float* signals, std::size_t count, double sigma, double threshold) {
  BIN_SCENES_ASSERT(sigma >= 0.0 && threshold >= 0.0);
  const float* const top = std::max_element(signals, signals + count);
  const auto reach = std::max<std::ptrdiff_t>(1, std::lround(sigma));
  if (top == signals + count || *top < threshold || top - signals < reach || signals + count - top <= reach) {
    return std::nullopt;
  }
  constexpr float dark = 1e-4f;  // a row without any light has no logarithm
  const double before = std::log(std::max(top[-reach], dark)), peak = std::log(*top),
               after = std::log(std::max(top[reach], dark));
  const double bend = before - 2.0 * peak + after;
  const double shift = bend < 0.0 ? 0.5 * static_cast<double>(reach) * (before - after) / bend : 0.0;
  BIN_SCENES_ASSERT(std::abs(shift) <= 0.5 * static_cast<double>(reach));  // the top is no lower than its neighbours
  return LinePeak{static_cast<double>(top - signals) + shift, *top};
}

}  // namespace bin_scenes
