#include "sensor/models/noise_field.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/in_parallel.hpp"

#include <cmath>
#include <numeric>

namespace bin_scenes {

std::vector<float> correlated_noise(int width, int height, double window, const Random& random) {
  // A box of w pixels has the variance (w^2 - 1) / 12: the Gaussian of the same width.
  BIN_SCENES_ASSERT(width > 0 && height > 0 && std::isfinite(window));
  const double sigma = std::sqrt(std::max(window * window - 1.0, 0.0) / 12.0);
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<float> kernel;
  double square = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(sigma > 0.0 ? std::exp(-0.5 * k * k / (sigma * sigma)) : 1.0));
    square += kernel.back() * kernel.back();
  }
  for (float& k : kernel) k /= static_cast<float>(std::sqrt(square));  // keeps the variance of white noise
  BIN_SCENES_ASSERT(std::abs(std::inner_product(kernel.begin(), kernel.end(), kernel.begin(), 0.0) - 1.0) < 1e-4);

  // White noise over the image and a rim of the kernel's reach: rows first, then columns.
  const int wide = width + 2 * reach, high = height + 2 * reach;
  std::vector<float> rows(static_cast<std::size_t>(width) * high),
      field(static_cast<std::size_t>(width) * height, 0.0f);
  in_parallel(static_cast<std::size_t>(high), [&](std::size_t y) {
    Random own = random.of_piece(y);
    std::vector<float> white(static_cast<std::size_t>(wide) + 1);
    for (int x = 0; x < wide; x += 2) {
      double a, b;
      own.normals(a, b);
      white[x] = static_cast<float>(a);
      white[x + 1] = static_cast<float>(b);
    }
    for (int x = 0; x < width; ++x) {
      float sum = 0.0f;
      for (int k = 0; k <= 2 * reach; ++k) sum += kernel[k] * white[x + k];
      rows[y * width + x] = sum;
    }
  });
  in_parallel(static_cast<std::size_t>(height), [&](std::size_t y) {
    float* const out = &field[y * width];
    for (int k = 0; k <= 2 * reach; ++k) {
      const float* const in = &rows[(y + k) * width];
      for (int x = 0; x < width; ++x) out[x] += kernel[k] * in[x];
    }
  });
  return field;
}

}  // namespace bin_scenes
