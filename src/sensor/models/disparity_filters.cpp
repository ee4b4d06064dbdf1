#include "sensor/models/disparity_filters.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

double rounded_to_step(double disparity, double step) {
  return step > 0.0 ? std::round(disparity / step) * step : disparity;
}

}  // namespace bin_scenes
