#include "sensor/models/facets.hpp"

#include "bin_scenes/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

double slant(double cosine, double a2) {
  return std::sqrt(cosine * cosine * (1.0 - a2) + a2);
}

/// Share of light from a direction that leaves after one facet: the mean of G2 / G1 over the facets that the direction
/// sees (Heitz 2018, "Sampling the GGX distribution of visible normals").
double single(double cosine, double alpha) {
  constexpr int steps = 32;
  const double a2 = alpha * alpha;
  const Vec3 in(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  const Vec3 stretched = Vec3(alpha * in.x(), 0.0, in.z()).normalized();
  const Vec3 along(0.0, 1.0, 0.0), up = stretched.cross(along);
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double radius = std::sqrt((i + 0.5) / steps);
    for (int k = 0; k < steps; ++k) {
      const double turn = 2.0 * M_PI * (k + 0.5) / steps, x = radius * std::cos(turn), s = 0.5 * (1.0 + stretched.z());
      const double y = (1.0 - s) * std::sqrt(1.0 - x * x) + s * radius * std::sin(turn);
      const Vec3 seen = x * along + y * up + std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * stretched;
      const Vec3 facet = Vec3(alpha * seen.x(), alpha * seen.y(), std::max(0.0, seen.z())).normalized();
      const double out = (2.0 * in.dot(facet) * facet - in).z();
      if (out <= 0.0) continue;
      const double own = slant(cosine, a2);
      sum += out * (cosine + own) / (cosine * slant(out, a2) + out * own);
    }
  }
  return sum / (steps * steps);
}

/// single() over roughness (square root of alpha) and the square root of the cosine, where it bends most, and its mean
/// over the hemisphere.
class Table {
 public:
  Table() {
    for (int r = 0; r <= roughnesses; ++r) {
      const double roughness = static_cast<double>(r) / roughnesses, alpha = std::max(roughness * roughness, 1e-3);
      for (int c = 0; c <= cosines; ++c) {
        const double root = static_cast<double>(c) / cosines;
        values_[r][c] = single(std::max(root * root, 1e-4), alpha);
      }
      constexpr int fine = 1024;
      double sum = 0.0;
      for (int i = 0; i < fine; ++i) {
        const double root = (i + 0.5) / fine;
        sum += along(values_[r], root * cosines) * 4.0 * root * root * root / fine;  // 2 c dc = 4 root^3 d root
      }
      means_[r] = sum;
    }
  }
  double at(double roughness, double cosine) const {
    const double row = roughness * roughnesses, column = std::sqrt(cosine) * cosines;
    const int r = std::min(static_cast<int>(row), roughnesses - 1);
    const double low = along(values_[r], column), high = along(values_[r + 1], column);
    return low + (row - r) * (high - low);
  }
  double mean(double roughness) const { return along(means_, roughness * roughnesses); }

 private:
  static constexpr int roughnesses = 24, cosines = 32;
  template <class Values>
  static double along(const Values& values, double place) {
    const int i = std::min(static_cast<int>(place), static_cast<int>(values.size()) - 2);
    return values[i] + (place - i) * (values[i + 1] - values[i]);
  }
  std::array<std::array<double, cosines + 1>, roughnesses + 1> values_;
  std::array<double, roughnesses + 1> means_;
};

}  // namespace

double facet_lobe(double alpha, double in, double out, double half, double once, double often) {
  static const Table table;
  const double a2 = alpha * alpha, bend = half * half * (a2 - 1.0) + 1.0, roughness = std::sqrt(alpha);
  const double facets = a2 / (M_PI * bend * bend);
  const double visible = 0.5 / (in * slant(out, a2) + out * slant(in, a2));
  const double mean = table.mean(roughness), lost = std::max(1.0 - mean, 1e-6);
  const double again = (1.0 - table.at(roughness, in)) * (1.0 - table.at(roughness, out)) / lost;
  if (once == 1.0 && often == 1.0) return (M_PI * facets * visible + again) * in;
  // Each facet more takes its share again (Kulla and Conty).
  const double kept = often * often * mean / (1.0 - often * lost);
  return (M_PI * facets * visible * once + again * kept) * in;
}

double fresnel(double cosine, double refraction, double extinction) {
  const double c2 = cosine * cosine, s2 = 1.0 - c2, n2 = refraction * refraction, k2 = extinction * extinction;
  const double real = n2 - k2 - s2, size = std::sqrt(real * real + 4.0 * n2 * k2);  // of (n + i k)^2 - sin^2
  const double twice = 2.0 * std::sqrt(std::max(0.0, 0.5 * (size + real))) * cosine;
  const double across = (size + c2 - twice) / (size + c2 + twice);
  const double sum = c2 * size + s2 * s2;
  const double along = across * (sum - twice * s2) / (sum + twice * s2);
  return 0.5 * (across + along);
}

double mean_fresnel(double refraction, double extinction) {
  struct Known {
    double refraction = -1.0, extinction = -1.0, mean = 0.0;
  };
  thread_local Known known;  // one metal is asked many times
  if (known.refraction != refraction || known.extinction != extinction) {
    constexpr int steps = 64;
    known = {refraction, extinction, 0.0};
    for (int i = 0; i < steps; ++i) {
      const double c = (i + 0.5) / steps;
      known.mean += fresnel(c, refraction, extinction) * 2.0 * c / steps;
    }
  }
  return known.mean;
}

}  // namespace bin_scenes
