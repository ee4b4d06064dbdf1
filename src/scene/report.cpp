#include "bin_scenes/scene/report.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>

namespace bin_scenes {

Quantiles quantiles(std::vector<double> values) {
  if (values.empty()) return {};
  BIN_SCENES_ASSERT(
      each_is(values, [](double value) { return !std::isnan(value); }));  // which no order has a place for
  std::sort(values.begin(), values.end());
  const auto at = [&](double f) {
    return values[std::min(values.size() - 1, static_cast<std::size_t>(f * static_cast<double>(values.size())))];
  };
  return {at(0.5), at(0.95), values.back()};
}

}  // namespace bin_scenes
