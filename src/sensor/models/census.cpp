/// Signatures of two images, their costs summed over a window row by row, and the tests that a match must pass.
#include "sensor/models/census.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace bin_scenes {

namespace {

/// Signatures of an image, a byte of each in each plane. Rows begin with `rim` pixels that do not exist.
class Signatures {
 public:
  Signatures(const std::vector<std::uint8_t>& image, int width, int height, int edge, int rim)
      : wide_(width + rim), rim_(rim), planes_((census_bits(edge) + 7) / 8) {
    bytes_.assign(static_cast<std::size_t>(planes_) * height * wide_, 0);
    height_ = height;
    const int reach = edge / 2;
    in_parallel(static_cast<std::size_t>(height), [&](std::size_t row) {
      std::vector<const std::uint8_t*> lines;
      for (int v = -reach; v <= reach; ++v)
        lines.push_back(&image[static_cast<std::size_t>(std::clamp(static_cast<int>(row) + v, 0, height - 1)) * width]);
      int bit = 0;
      for (int v = 0; v <= reach; ++v) {
        for (int u = v == 0 ? 1 : -reach; u <= reach; ++u, ++bit) {
          std::uint8_t* const out = &bytes_[place(bit / 8, static_cast<int>(row))] + rim;
          add_bit(lines[reach - v], lines[reach + v], u, width, static_cast<std::uint8_t>(1u << (bit % 8)), out);
        }
      }
    });
  }
  int planes() const { return planes_; }
  /// Of the pixel in column 0.
  const std::uint8_t* row(int plane, int y) const { return &bytes_[place(plane, y)] + rim_; }

 private:
  /// Sets the bit where the pixel u to the left in `first` is brighter than the one u to the right in `second`.
  static void add_bit(const std::uint8_t* first, const std::uint8_t* second, int u, int width, std::uint8_t bit,
                      std::uint8_t* out) {
    const int inner = std::min(std::abs(u), width);
    const auto set = [&](int x) {
      const bool brighter = first[std::clamp(x - u, 0, width - 1)] > second[std::clamp(x + u, 0, width - 1)];
      out[x] = static_cast<std::uint8_t>(out[x] | (brighter ? bit : 0));
    };
    for (int x = 0; x < inner; ++x) set(x);
    for (int x = inner; x < width - inner; ++x) {
      out[x] = static_cast<std::uint8_t>(out[x] | (first[x - u] > second[x + u] ? bit : 0));
    }
    for (int x = std::max(inner, width - inner); x < width; ++x) set(x);
  }
  std::size_t place(int plane, int y) const {
    return (static_cast<std::size_t>(plane) * height_ + y) * static_cast<std::size_t>(wide_);
  }

  int wide_, rim_, planes_, height_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// The number of bits set in each byte.
std::uint64_t bits_of_bytes(std::uint64_t v) {
  v -= (v >> 1) & 0x5555555555555555u;
  v = (v & 0x3333333333333333u) + ((v >> 2) & 0x3333333333333333u);
  return (v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fu;
}

/// Adds to each of `count` costs, a multiple of 8, the bits by which `other` differs from `own`.
void add_differences(std::uint8_t own, const std::uint8_t* other, int count, std::uint8_t* costs) {
  const std::uint64_t all = own * 0x0101010101010101u;
  for (int k = 0; k < count; k += 8) {
    std::uint64_t bytes, sum;
    std::memcpy(&bytes, other + k, 8);
    std::memcpy(&sum, costs + k, 8);
    sum += bits_of_bytes(bytes ^ all);
    std::memcpy(costs + k, &sum, 8);
  }
}

/// What the first image's pixel of a column found, and the second image's.
struct Found {
  int disparity = -1;  ///< above the least one; -1: none
  double fraction = 0.0;
};

/// Matches a band of rows. Costs of a pixel are in the order of descending disparity, which is that of the second
/// image's columns.
class Band {
 public:
  Band(const Signatures& first, const Signatures& second, int width, int height, const StereoSettings& s,
       const StereoPipeline& pipeline, int least)
      : first_(first),
        second_(second),
        width_(width),
        height_(height),
        count_(s.disparities),
        least_(least),
        reach_(s.window / 2),
        bits_(census_bits(pipeline.census)),
        margin_(pipeline.second_peak * bits_ * s.window * s.window),
        agree_(s.max_difference),
        columns_(static_cast<std::size_t>(width) * count_, 0),
        window_(count_),
        best_of_second_(static_cast<std::size_t>(width) + count_ + least),
        disparity_of_second_(best_of_second_.size()),
        found_(width) {
    for (int k = 0; k < s.window; ++k) ring_.emplace_back(static_cast<std::size_t>(width) * count_);
  }

  void match(int top, int bottom, std::vector<float>& disparities) {
    for (int y = top - reach_; y < top + reach_; ++y) add_row(y);
    for (int y = top; y < bottom; ++y) {
      add_row(y + reach_);
      match_row();
      float* const out = &disparities[static_cast<std::size_t>(y) * width_];
      for (int x = 0; x < width_; ++x) out[x] = agreed(x);
      remove_row(y - reach_);
    }
  }

 private:
  std::vector<std::uint8_t>& ring(int y) { return ring_[static_cast<std::size_t>(y + reach_) % ring_.size()]; }

  /// Rows beyond the border are those at the border.
  void add_row(int y) {
    std::vector<std::uint8_t>& costs = ring(y);
    std::fill(costs.begin(), costs.end(), std::uint8_t{0});
    const int row = std::clamp(y, 0, height_ - 1);
    for (int plane = 0; plane < first_.planes(); ++plane) {
      const std::uint8_t *const own = first_.row(plane, row), *const other = second_.row(plane, row);
      for (int x = 0; x < width_; ++x) {
        add_differences(own[x], other + x - least_ - count_ + 1, count_, &costs[static_cast<std::size_t>(x) * count_]);
      }
    }
    // Of what lies beyond the second image's border nothing is known: all bits differ.
    for (int x = 0; x < std::min(width_, least_ + count_ - 1); ++x) {
      std::fill_n(costs.begin() + static_cast<std::ptrdiff_t>(x) * count_, std::min(count_, least_ + count_ - 1 - x),
                  static_cast<std::uint8_t>(bits_));
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i] = static_cast<std::int16_t>(columns_[i] + costs[i]);
  }
  void remove_row(int y) {
    const std::vector<std::uint8_t>& costs = ring(y);
    for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i] = static_cast<std::int16_t>(columns_[i] - costs[i]);
  }
  const std::int16_t* column(int x) const {
    return &columns_[static_cast<std::size_t>(std::clamp(x, 0, width_ - 1)) * count_];
  }

  void match_row() {
    std::fill(best_of_second_.begin(), best_of_second_.end(), std::numeric_limits<std::int16_t>::max());
    std::fill(window_.begin(), window_.end(), std::int16_t{0});
    const std::vector<std::int16_t> nothing(window_.size(), 0);
    for (int x = -reach_ - 1; x < reach_; ++x) move(column(x), nothing.data());
    for (int x = 0; x < width_; ++x) {
      move(column(x + reach_), column(x - reach_ - 1));
      compare_with_second(x);
      found_[static_cast<std::size_t>(x)] = best();
    }
  }
  void move(const std::int16_t* in, const std::int16_t* out) {
    for (int k = 0; k < count_; ++k) window_[k] = static_cast<std::int16_t>(window_[k] + in[k] - out[k]);
  }
  /// Each pixel of the second image keeps the disparity that fits it best.
  void compare_with_second(int x) {
    std::int16_t* const best = &best_of_second_[static_cast<std::size_t>(x)];
    std::int16_t* const disparity = &disparity_of_second_[static_cast<std::size_t>(x)];
    for (int k = 0; k < count_; ++k) {
      const bool better = window_[k] < best[k];
      best[k] = better ? window_[k] : best[k];
      disparity[k] = better ? static_cast<std::int16_t>(k) : disparity[k];
    }
  }
  static std::int16_t least_of(const std::int16_t* values, int count) {
    std::int16_t least = std::numeric_limits<std::int16_t>::max();
    for (int k = 0; k < count; ++k) least = std::min(least, values[k]);
    return least;
  }
  Found best() const {
    const std::int16_t* const costs = window_.data();
    const std::int16_t least = least_of(costs, count_);
    const int at = static_cast<int>(std::find(costs, costs + count_, least) - costs);
    const int second = std::min<int>(least_of(costs, at - 1), least_of(costs + at + 2, count_ - at - 2));
    if (second - least < margin_) return {};
    Found found{count_ - 1 - at, 0.0};
    if (at == 0 || at == count_ - 1) return found;
    // Costs of bits grow linearly to both sides, with the same slope. Of the neighbours the one to the left has the
    // larger disparity.
    const int rise = std::max(costs[at - 1], costs[at + 1]) - least;
    if (rise > 0) found.fraction = 0.5 * (costs[at + 1] - costs[at - 1]) / rise;
    return found;
  }
  float agreed(int x) const {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    const Found& found = found_[static_cast<std::size_t>(x)];
    const double disparity = found.disparity + found.fraction;
    const int column = x - least_ - static_cast<int>(std::lround(disparity));
    if (found.disparity < 0 || column < 0) return none;
    const std::size_t place = static_cast<std::size_t>(column) + least_ + count_ - 1;
    if (std::abs(count_ - 1 - disparity_of_second_[place] - disparity) > agree_) return none;
    return static_cast<float>(least_ + disparity);
  }

  const Signatures &first_, &second_;
  int width_, height_, count_, least_, reach_, bits_;
  double margin_, agree_;
  std::vector<std::vector<std::uint8_t>> ring_;  ///< costs of the rows of the window, by column and disparity
  std::vector<std::int16_t> columns_;            ///< their sums
  std::vector<std::int16_t> window_;             ///< sums over the window, by disparity
  // By column of the second image + least + count - 1.
  std::vector<std::int16_t> best_of_second_, disparity_of_second_;
  std::vector<Found> found_;
};

}  // namespace

std::vector<float> match_census(const Stereo::Pair& images, int width, int height, const StereoSettings& settings,
                                const StereoPipeline& pipeline, int least_disparity) {
  constexpr int rows = 60;  // of a band: more are fewer rows that two bands compute both, fewer keep more cores busy
  const Signatures first(images.first, width, height, pipeline.census, 0);
  const Signatures second(images.second, width, height, pipeline.census, least_disparity + settings.disparities);
  std::vector<float> disparities(images.first.size());
  in_parallel(static_cast<std::size_t>((height + rows - 1) / rows), [&](std::size_t band) {
    const int top = static_cast<int>(band) * rows;
    Band(first, second, width, height, settings, pipeline, least_disparity)
        .match(top, std::min(height, top + rows), disparities);
  });
  return disparities;
}

}  // namespace bin_scenes
