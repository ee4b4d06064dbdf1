#include "core/in_parallel.hpp"
#include "sensor/models/stereo.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

/// Grey levels with a rim of repeated border pixels, so that windows need no bounds. Smoothed along rows: what changes
/// from pixel to pixel has no place between pixels.
class Padded {
 public:
  Padded(const std::vector<std::uint8_t>& image, int width, int height, int rim)
      : rim_(rim), wide_(width + 2 * rim), values_(static_cast<std::size_t>(wide_) * (height + 2 * rim)) {
    for (int y = -rim; y < height + rim; ++y) {
      const std::uint8_t* const in = &image[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width];
      float* const out = row(y);
      const auto at = [&](int x) { return static_cast<float>(in[std::clamp(x, 0, width - 1)]); };
      for (int x = -rim; x < width + rim; ++x) out[x] = 0.25f * (at(x - 1) + at(x + 1)) + 0.5f * at(x);
    }
  }
  float* row(int y) { return &values_[static_cast<std::size_t>(y + rim_) * wide_ + rim_]; }
  const float* row(int y) const { return &values_[static_cast<std::size_t>(y + rim_) * wide_ + rim_]; }

 private:
  int rim_, wide_;
  std::vector<float> values_;
};

/// Weights of the pixels -1, 0, 1, 2 for a place between 0 and 1 (Keys 1981, "Cubic convolution interpolation").
std::array<float, 4> cubic(float t) {
  return {t * (-0.5f + t * (1.0f - 0.5f * t)), 1.0f + t * t * (-2.5f + 1.5f * t), t * (0.5f + t * (2.0f - 1.5f * t)),
          t * t * (-0.5f + 0.5f * t)};
}

/// A window around a pixel of the first image, and the one that a disparity names in the second.
class Windows {
 public:
  Windows(const Padded& first, const Padded& second, int window)
      : first_(first), second_(second), reach_(window / 2), count_(static_cast<std::size_t>(window) * window) {
    own_.resize(count_);
    slope_.resize(count_);
    other_.resize(count_);
  }

  void place(int x, int y) {
    x_ = x, y_ = y;
    std::size_t at = 0;
    steepness_ = 0.0f;
    for (int v = y - reach_; v <= y + reach_; ++v) {
      const float* const in = first_.row(v);
      for (int u = x - reach_; u <= x + reach_; ++u, ++at) {
        own_[at] = in[u];
        slope_[at] = 0.5f * (in[u + 1] - in[u - 1]);
        steepness_ += slope_[at] * slope_[at];
      }
    }
    spread_ = centred(own_);
  }

  /// One step of Gauss and Newton towards the disparity at which both windows differ least; 0 without texture.
  float step(float disparity) {
    const float place = static_cast<float>(x_) - disparity, whole = std::floor(place);
    const std::array<float, 4> w = cubic(place - whole);
    const int shift = static_cast<int>(whole) - x_;
    std::size_t at = 0;
    for (int v = y_ - reach_; v <= y_ + reach_; ++v) {
      const float* const in = second_.row(v) + x_ - reach_ + shift;
      for (int u = 0; u <= 2 * reach_; ++u, ++at) {
        other_[at] = w[0] * in[u - 1] + w[1] * in[u] + w[2] * in[u + 1] + w[3] * in[u + 2];
      }
    }
    const float spread = centred(other_);
    if (!(steepness_ > 0.0f && spread > 0.0f)) return 0.0f;
    // Light may be brighter for one camera than for the other: both windows get the same mean and spread.
    const float gain = spread_ / spread;
    float sum = 0.0f;
    for (std::size_t i = 0; i < count_; ++i) sum += slope_[i] * (own_[i] - gain * other_[i]);
    return -sum / steepness_;
  }

 private:
  /// Takes the mean away; the root of the sum of squares that is left.
  float centred(std::vector<float>& values) const {
    float sum = 0.0f, square = 0.0f;
    for (const float v : values) sum += v;
    for (float& v : values) {
      v -= sum / static_cast<float>(count_);
      square += v * v;
    }
    return std::sqrt(square);
  }

  const Padded& first_;
  const Padded& second_;
  int reach_, x_ = 0, y_ = 0;
  std::size_t count_;
  std::vector<float> own_, slope_, other_;
  float steepness_ = 0.0f, spread_ = 0.0f;
};

}  // namespace

void refine(const Stereo::Pair& images, int width, int height, int window, std::vector<float>& disparities) {
  constexpr int steps = 5;
  constexpr float close = 0.01f, most = 1.0f;  // pixel: where steps end, and how far they may lead in all
  const int rim = window / 2 + 3;
  const Padded first(images.first, width, height, rim), second(images.second, width, height, rim);
  in_parallel(static_cast<std::size_t>(height), [&](std::size_t y) {
    Windows windows(first, second, window);
    for (int x = 0; x < width; ++x) {
      float& disparity = disparities[y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      if (std::isnan(disparity)) continue;
      windows.place(x, static_cast<int>(y));
      float found = disparity;
      for (int k = 0; k < steps && std::abs(found - disparity) <= most; ++k) {
        const float step = windows.step(std::clamp(found, 0.0f, static_cast<float>(x)));
        found += step;
        if (std::abs(step) < close) break;
      }
      if (std::abs(found - disparity) <= most && found >= 0.0f) disparity = found;
    }
  });
}

}  // namespace bin_scenes
