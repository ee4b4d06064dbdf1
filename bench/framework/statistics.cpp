#include "framework/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes::bench {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double quantile(std::vector<double> samples, double q) {
  if (samples.empty()) return nan;
  std::sort(samples.begin(), samples.end());
  const double at = q * static_cast<double>(samples.size() - 1);
  const std::size_t below = static_cast<std::size_t>(at), above = std::min(below + 1, samples.size() - 1);
  return samples[below] + (at - static_cast<double>(below)) * (samples[above] - samples[below]);
}

double median(std::vector<double> samples) {
  return quantile(std::move(samples), 0.5);
}

double range(const std::vector<double>& samples) {
  if (samples.empty()) return 0.0;
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  return *most - *least;
}

double wasserstein(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) return nan;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  // Both quantile functions are steps; walk over the union of their steps.
  double area = 0.0, share = 0.0;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const double end_a = static_cast<double>(i + 1) / static_cast<double>(a.size());
    const double end_b = static_cast<double>(k + 1) / static_cast<double>(b.size());
    const double end = std::min(end_a, end_b);
    area += (end - share) * std::abs(a[i] - b[k]);
    share = end;
    if (end_a <= end) ++i;
    if (end_b <= end) ++k;
  }
  return area;
}

double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]) - mean_x;
    xx += u * u;
    xy += u * (std::log(y[i]) - mean_y);
  }
  constexpr double same = 1e-12;  // variance of logarithms that are equal but for rounding
  return xx > same ? xy / xx : nan;
}

}  // namespace bin_scenes::bench
