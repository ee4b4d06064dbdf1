#include "sensor/models/imager.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

Imager::Imager(const ImagerSettings& s, bool noise)
    : shot_(1.0 / s.full_well),
      read_(s.read_noise * s.read_noise / (s.full_well * s.full_well)),
      steps_(std::ldexp(1.0, s.bits) - 1.0),
      rounding_(1.0 / (12.0 * steps_ * steps_)),
      noise_(noise) {}

double Imager::variance(double signal) const {
  return shot_ * std::max(signal, 0.0) + read_ + rounding_;
}

void Imager::expose(float* signals, std::size_t count, Random& random) const {
  for (std::size_t i = 0; i < count; i += 2) {
    double draw[2] = {0.0, 0.0};
    if (noise_) random.normals(draw[0], draw[1]);
    for (std::size_t k = i; k < std::min(i + 2, count); ++k) {
      const double mean = signals[k];
      // Of thousands of electrons the Poisson distribution is a normal one.
      const double value = noise_ ? mean + std::sqrt(shot_ * std::max(mean, 0.0) + read_) * draw[k - i] : mean;
      signals[k] = static_cast<float>(std::round(std::clamp(value, 0.0, 1.0) * steps_) / steps_);
    }
  }
}

double gain_of(const ImagerSettings& imager, const std::vector<Lit>& lit, const std::vector<double>& depths,
               double light_z) {
  if (imager.reference_distance > 0.0) return imager.exposure * imager.reference_distance * imager.reference_distance;
  std::vector<double> losses;  // distance^2 / cosine
  for (std::size_t i = 0; i < lit.size(); ++i) {
    if (lit[i].code != Validity::valid) continue;
    const double distance = lit[i].distance;
    losses.push_back(distance * distance * distance / std::max(std::abs(depths[i] - light_z), 1e-6));
  }
  if (losses.empty()) return imager.exposure;
  const auto median = losses.begin() + static_cast<std::ptrdiff_t>(losses.size() / 2);
  std::nth_element(losses.begin(), median, losses.end());
  return imager.exposure * *median;
}

}  // namespace bin_scenes
