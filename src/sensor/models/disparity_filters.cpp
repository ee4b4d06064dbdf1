/// Filters of disparities as librealsense has them (smoothing along rows and columns, averages over images, filling of
/// holes, decimation, rounding), and the share of the noise that they keep.
#include "sensor/models/disparity_filters.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bin_scenes {

namespace {

/// One pass over a line of `count` pixels that are `step` apart.
void pass(const SpatialFilter& settings, float* pixel, std::ptrdiff_t step, int count) {
  const auto alpha = static_cast<float>(settings.alpha), delta = static_cast<float>(settings.delta);
  float before = *pixel, filtered = *pixel;
  for (int k = 1; k < count; ++k) {
    pixel += step;
    const float own = *pixel;
    // A difference from NaN is less than nothing.
    filtered = std::abs(own - before) < delta ? alpha * own + (1.0f - alpha) * filtered : own;
    before = own;
    *pixel = filtered;
  }
}

/// The pass over all columns of a block at once, row by row, so that memory is read in its order.
void pass_rows(const SpatialFilter& settings, float* first, std::ptrdiff_t step, int rows, int columns) {
  const auto alpha = static_cast<float>(settings.alpha), delta = static_cast<float>(settings.delta);
  std::vector<float> before(first, first + columns), filtered = before;
  for (int row = 1; row < rows; ++row) {
    float* const pixel = first + row * step;
    for (int x = 0; x < columns; ++x) {
      const float own = pixel[x];
      filtered[x] = std::abs(own - before[x]) < delta ? alpha * own + (1.0f - alpha) * filtered[x] : own;
      before[x] = own;
      pixel[x] = filtered[x];
    }
  }
}

/// Variance of Gaussian noise with the correlation of correlated_noise() under the kernel, per dimension.
double variance_along(const SpatialFilter& settings, double window) {
  // Convolved with itself, the kernel of all iterations; the correlation of the noise falls with twice the variance of
  // the box.
  const double rest = 1.0 - settings.alpha, peak = settings.alpha / (2.0 - settings.alpha);
  constexpr int reach = 400;
  std::vector<double> kernel(2 * reach + 1, 0.0);
  kernel[reach] = 1.0;
  for (int pair = 0; pair < 2 * settings.iterations; ++pair) {  // the kernel and its mirror image are the same
    std::vector<double> forward = kernel, back = kernel;
    for (int k = 1; k <= 2 * reach; ++k) forward[k] += rest * forward[k - 1];
    for (int k = 2 * reach - 1; k >= 0; --k) back[k] += rest * back[k + 1];
    for (int k = 0; k <= 2 * reach; ++k) kernel[k] = peak * (forward[k] + back[k] - kernel[k]);
  }
  const double spread = 2.0 * std::max(window * window - 1.0, 0.0) / 12.0;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    const double like = spread > 0.0 ? std::exp(-0.5 * k * k / spread) : (k == 0 ? 1.0 : 0.0);
    sum += kernel[k + reach] * like;
  }
  return sum;
}

}  // namespace

void filter_spatially(const SpatialFilter& settings, int width, int height, std::vector<float>& disparities) {
  constexpr int block = 64;  // columns that one task filters
  const std::ptrdiff_t wide = width;
  for (int k = 0; k < settings.iterations; ++k) {
    in_parallel(static_cast<std::size_t>(height), [&](std::size_t row) {
      float* const first = &disparities[row * static_cast<std::size_t>(width)];
      pass(settings, first, 1, width);
      pass(settings, first + width - 1, -1, width);
    });
    in_parallel(static_cast<std::size_t>((width + block - 1) / block), [&](std::size_t task) {
      const int left = static_cast<int>(task) * block, columns = std::min(block, width - left);
      pass_rows(settings, &disparities[left], wide, height, columns);
      pass_rows(settings, &disparities[(height - 1) * wide + left], -wide, height, columns);
    });
  }
}

double spatially_filtered_noise(const SpatialFilter& settings, double window) {
  if (settings.iterations == 0) return 1.0;
  return variance_along(settings, window);  // the square root of the product of both dimensions
}

bool TemporalAverage::persists(unsigned history) const {
  struct Rule {
    unsigned images, of;
  };
  // In the order of the enumeration.
  constexpr Rule rules[] = {{1, 0}, {8, 8}, {2, 3}, {2, 4}, {2, 8}, {1, 2}, {1, 5}, {1, 8}, {0, 0}};
  const Rule rule = rules[static_cast<int>(settings_.persistence)];
  return std::bitset<8>(history & ((1u << rule.of) - 1)).count() >= rule.images;
}

void TemporalAverage::add(std::vector<float>& disparities) {
  last_.resize(disparities.size(), std::numeric_limits<float>::quiet_NaN());
  measured_.resize(disparities.size(), 0);
  const auto alpha = static_cast<float>(settings_.alpha), delta = static_cast<float>(settings_.delta);
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    const unsigned history = measured_[i];
    if (std::isnan(disparities[i])) {
      if (persists(history)) disparities[i] = last_[i];
      measured_[i] = static_cast<std::uint8_t>(history << 1);
      continue;
    }
    const bool agree = std::abs(disparities[i] - last_[i]) < delta;
    if (agree) disparities[i] = alpha * disparities[i] + (1.0f - alpha) * last_[i];
    last_[i] = disparities[i];
    measured_[i] = static_cast<std::uint8_t>(agree ? history << 1 | 1u : 1u);
  }
}

double temporally_filtered_noise(const TemporalFilter& settings) {
  const double steady = settings.alpha / (2.0 - settings.alpha);
  return std::sqrt(steady + (1.0 - steady) * std::pow(1.0 - settings.alpha, 2 * (settings.frames - 1)));
}

void fill_holes(HoleFilling filling, int width, int height, std::vector<float>& disparities) {
  if (filling == HoleFilling::off) return;
  const auto at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && y < height;
    return inside ? disparities[static_cast<std::size_t>(y) * width + x] : std::numeric_limits<float>::quiet_NaN();
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float& pixel = disparities[static_cast<std::size_t>(y) * width + x];
      if (!std::isnan(pixel)) continue;
      pixel = at(x - 1, y);
      if (filling == HoleFilling::left) continue;
      for (const float other : {at(x - 1, y - 1), at(x, y - 1), at(x - 1, y + 1), at(x, y + 1)})
        pixel = filling == HoleFilling::farthest ? std::fmin(pixel, other) : std::fmax(pixel, other);  // not NaN
    }
  }
}

std::vector<float> decimated(int factor, int width, int height, const std::vector<float>& disparities) {
  constexpr int largest_median = 3;
  const int columns = width / factor, rows = height / factor;
  std::vector<float> out(static_cast<std::size_t>(columns) * rows, std::numeric_limits<float>::quiet_NaN());
  in_parallel(static_cast<std::size_t>(rows), [&](std::size_t row) {
    std::vector<float> found;
    for (int column = 0; column < columns; ++column) {
      found.clear();
      for (int k = 0; k < factor * factor; ++k) {
        const float value = disparities[(row * factor + k / factor) * width + column * factor + k % factor];
        if (!std::isnan(value)) found.push_back(value);
      }
      if (found.empty()) continue;
      float& pixel = out[row * static_cast<std::size_t>(columns) + column];
      if (factor <= largest_median) {
        const auto median = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
        std::nth_element(found.begin(), median, found.end());
        pixel = *median;
      } else {
        float depths = 0.0f;  // of a camera with baseline * focal length = 1
        for (const float value : found) depths += 1.0f / value;
        pixel = static_cast<float>(found.size()) / depths;
      }
    }
  });
  return out;
}

double rounded_to_step(double disparity, double step) {
  return step > 0.0 ? std::round(disparity / step) * step : disparity;
}

}  // namespace bin_scenes
