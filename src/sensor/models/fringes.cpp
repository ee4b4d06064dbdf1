/// Adds light to the images of a pixel, and reads phase and Gray code from them. The sigma of the column follows from
/// the noise at the fringe's mean.
#include "sensor/models/fringes.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace bin_scenes {

namespace {

constexpr int samples = 16;     // of the table in a column: linear between them errs by 1e-4 of the amplitude
constexpr int margin = 8;       // columns that the pattern goes on beyond the projector's edges, for the blur
constexpr double levels = 255;  // a projector shows 8 bits

int bits_for(double halves) {
  int bits = 1;
  while (std::ldexp(1.0, bits) < halves) ++bits;
  return bits;
}

/// sin(x) / x for x^2 up to pi^2, 0 beyond: a footprint of more than a period. By its series, within 1e-6.
double box(double square) {
  if (square >= M_PI * M_PI) return 0.0;
  double sum = 1.0;
  if (square < 1.0) {  // the usual footprint
    for (const int n : {9, 7, 5, 3}) sum = 1.0 - sum * square * (1.0 / (n * (n - 1)));
    return sum;
  }
  for (const int n : {15, 13, 11, 9, 7, 5, 3}) sum = 1.0 - sum * square * (1.0 / (n * (n - 1)));
  return sum;
}

/// Share of a normal distribution below x.
double below(double x) {
  return 0.5 * std::erfc(-x * M_SQRT1_2);
}

/// Light of a projector's pixel in the columns from `reach` before to `reach` after it, for each of the places in a
/// column that the table has.
std::vector<double> shares_of_neighbours(double sigma, int reach) {
  std::vector<double> shares;
  for (int k = 0; k < samples; ++k) {
    const double column = static_cast<double>(k) / samples - 0.5, center = std::floor(column + 0.5);
    for (int j = -reach; j <= reach; ++j)
      shares.push_back(below((center + j + 0.5 - column) / sigma) - below((center + j - 0.5 - column) / sigma));
  }
  return shares;
}

int bits_of(const StructuredLightSettings& s, int width) {
  const int needed = bits_for(2.0 * std::ceil(width / s.period)), bits = s.gray_bits ? s.gray_bits : needed;
  if (bits < needed) {
    throw input_error(std::to_string(bits) + " Gray-code images distinguish " +
                          std::to_string(static_cast<int>(std::ldexp(1.0, bits - 1))) +
                          " fringes apart, the projector has " +
                          std::to_string(static_cast<int>(std::ceil(width / s.period))),
                      "structured_light.gray_bits",
                      "give " + std::to_string(needed) + ", 0 for as many as needed, or a longer period");
  }
  return bits;
}

}  // namespace

Fringes::Fringes(const StructuredLightSettings& settings, int width)
    : Fringes(settings, width, bits_of(settings, width)) {}

Fringes Fringes::without_code(StructuredLightSettings settings, double period, int width) {
  settings.period = period;
  return Fringes(settings, width, 0);
}

Fringes::Fringes(const StructuredLightSettings& s, int width, int bits)
    : steps_(s.steps),
      bits_(bits),
      width_(width),
      period_(s.period),
      averaging_(std::sqrt(2.0 / s.steps)),
      black_((1.0 - s.contrast) / (1.0 + s.contrast)) {
  const double q = s.defocus / period_, box = M_PI / period_;
  amplitude_ = 0.5 * (1.0 - black_) * std::exp(-2.0 * M_PI * M_PI * q * q) * std::sin(box) / box;
  for (int n = 0; n < steps_; ++n) {
    sine_.push_back(static_cast<float>(std::sin(2.0 * M_PI * n / steps_)));
    cosine_.push_back(static_cast<float>(std::cos(2.0 * M_PI * n / steps_)));
  }

  const int columns = width + 2 * margin, count = images();
  std::vector<float> shown(static_cast<std::size_t>(columns) * count);
  for (int j = 0; j < columns; ++j) {
    float* const out = &shown[static_cast<std::size_t>(j) * count];
    const double x = j - margin + 0.5;  // the centre of the projector's pixel, from the edge of its image
    const auto light = [&](double value) {
      const double level = std::round(levels * std::pow(value, s.gamma)) / levels;
      return static_cast<float>(black_ + (1.0 - black_) * level);
    };
    for (int n = 0; n < steps_; ++n) {
      out[n] = light(0.5 + 0.5 * std::cos(2.0 * M_PI * (x / period_ - static_cast<double>(n) / steps_)));
    }
    const int half = std::clamp(static_cast<int>(std::floor(2.0 * x / period_)), 0, (1 << bits_) - 1);
    const int gray = half ^ (half >> 1);
    for (int b = 0; b < bits_; ++b) out[steps_ + b] = light((gray >> (bits_ - 1 - b)) & 1);
  }

  // Each of the projector's pixels is a box; the lens blurs it to a difference of two error functions.
  const double sigma = std::max(s.defocus, 1e-3);
  const int reach = std::min(margin - 1, static_cast<int>(std::ceil(4.0 * sigma + 0.5)));
  table_.assign(static_cast<std::size_t>(samples * (width + 1) + 2) * count, 0.0f);
  const std::vector<double> shares = shares_of_neighbours(sigma, reach);
  std::vector<double> sum(count);
  for (int i = 0; i <= samples * (width + 1) + 1; ++i) {
    const double column = static_cast<double>(i) / samples - 0.5;
    const int center = static_cast<int>(std::floor(column + 0.5));
    std::fill(sum.begin(), sum.end(), 0.0);
    double total = 0.0;
    for (int j = center - reach; j <= center + reach; ++j) {
      const double share = shares[static_cast<std::size_t>(i % samples * (2 * reach + 1) + j - center + reach)];
      const float* const in = &shown[static_cast<std::size_t>(std::clamp(j + margin, 0, columns - 1)) * count];
      for (int n = 0; n < count; ++n) sum[n] += share * in[n];
      total += share;
    }
    for (int n = 0; n < count; ++n) {
      table_[static_cast<std::size_t>(i) * count + n] = static_cast<float>(sum[n] / total);
    }
  }
}

/// The row of the table for a column, with the fraction of the way to the next one.
double Fringes::row_of(double column) const {
  return std::clamp((column + 0.5) * samples, 0.0, static_cast<double>(samples) * (width_ + 1));
}

void Fringes::add_row(std::size_t row, float weight, float* images) const {
  const int count = this->images();
  const float* const light = &table_[row * count];
  for (int n = 0; n < count; ++n) images[n] += weight * light[n];
}

void Fringes::add_light(double column, double weight, float* images) const {
  const int count = this->images();
  const double at = row_of(column);
  const auto i = static_cast<std::size_t>(at);
  const auto part = static_cast<float>(at - static_cast<double>(i)), w = static_cast<float>(weight);
  const float* const a = &table_[i * count];
  const float* const b = a + count;
  for (int n = 0; n < count; ++n) images[n] += w * (a[n] + part * (b[n] - a[n]));
}

/// Sums the weights by rows of the table first: each row is then read once.
void Fringes::add_light(const std::vector<float>& columns, const std::vector<float>& weights, float* images) const {
  if (columns.empty()) return;
  const auto [least, most] = std::minmax_element(columns.begin(), columns.end());
  const auto first = static_cast<std::size_t>(row_of(*least)), last = static_cast<std::size_t>(row_of(*most)) + 1;
  thread_local std::vector<float> by_row;
  by_row.assign(last - first + 1, 0.0f);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const double at = row_of(columns[k]);
    const auto i = static_cast<std::size_t>(at);
    const auto part = static_cast<float>(at - static_cast<double>(i));
    by_row[i - first] += weights[k] * (1.0f - part);
    by_row[i - first + 1] += weights[k] * part;
  }
  for (std::size_t i = 0; i < by_row.size(); ++i) {
    if (by_row[i] > 0.0f) add_row(first + i, by_row[i], images);
  }
}

void Fringes::add_even_light(double column, double spread, double weight, float* images) const {
  constexpr double most = 12.0;  // places: a spread of two periods is grey already
  const int places = static_cast<int>(std::clamp(std::ceil(6.0 * spread / period_), 1.0, most));
  for (int k = 0; k < places; ++k) {
    const double at = row_of(column + spread * ((k + 0.5) / places - 0.5));
    add_row(static_cast<std::size_t>(at + 0.5), static_cast<float>(weight / places), images);
  }
}

Fringes::Phase Fringes::phase(const float* images) const {
  double s = 0.0, c = 0.0, mean = 0.0;
  for (int n = 0; n < steps_; ++n) {
    s += images[n] * sine_[n];
    c += images[n] * cosine_[n];
    mean += images[n];
  }
  mean /= steps_;
  double phase = std::atan2(s, c) / (2.0 * M_PI);  // in periods, from here on
  if (phase < 0.0) phase += 1.0;
  return {phase, 2.0 / steps_ * std::sqrt(s * s + c * c), mean};
}

Fringes::Reading Fringes::read(const float* images) const {
  const auto [phase, modulation, mean] = this->phase(images);
  int half = 0, bit = 0;
  unsigned unsure = 0;  // bits that are neither dark nor bright, by their weight
  for (int b = 0; b < bits_; ++b) {
    const double over = images[steps_ + b] - mean;
    unsure = 2 * unsure + (std::abs(over) > 0.25 * modulation ? 0u : 1u);
    bit ^= over > 0.0 ? 1 : 0;  // Gray to binary: each bit is the parity of those before it
    half = 2 * half + bit;
  }
  // Where halves change their number is never near the quarter that is read: at phase 0 the halves on both sides
  // round to the same period, at phase 1/2 the period's own bits do not change.
  const int own = half / 2, rounded = (half + 1) / 2;
  int number = own;
  if (phase < 0.25) {
    number = rounded;
  } else if (phase > 0.75) {
    number = rounded - 1;
  }
  // The half that begins nearest: of a Gray code one bit changes there, and only that may be grey.
  const int edge = 2 * number + static_cast<int>(std::lround(2.0 * phase));
  const unsigned changing = static_cast<unsigned>(edge & -edge);
  const bool near_edge = std::abs(2.0 * phase - std::round(2.0 * phase)) < 0.25;
  const bool sense = std::abs(number - own) <= 1 && (unsure & ~(near_edge ? changing : 0u)) == 0;
  double column = (number + phase) * period_ - 0.5;
  if (!sense || column < -0.5 - 1.0 || column > width_ - 0.5 + 1.0) column = std::numeric_limits<double>::quiet_NaN();
  return {column, modulation};
}

double Fringes::seen_through(double across, double down, double blur) const {
  const double a = M_PI / period_ * across, b = M_PI / period_ * down;
  const double factor = box(a * a) * box(b * b);
  return blur > 0.0 ? factor * std::exp(-2.0 * blur * blur * (a * a + b * b)) : factor;
}

double Fringes::brightest(double column) const {
  const double turns = (column + 0.5) / period_ * steps_;
  return std::cos(2.0 * M_PI / steps_ * (turns - std::round(turns)));
}

double Fringes::column_sigma(double image_sigma, double modulation) const {
  return period_ / (2.0 * M_PI) * amplitude_sigma(image_sigma) / modulation;
}

double Fringes::amplitude_sigma(double image_sigma) const {
  return averaging_ * image_sigma;
}

}  // namespace bin_scenes
