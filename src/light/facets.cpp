/// How much leaves after one facet is tabulated once, by sums over the facets that a direction sees; what is lost there
/// comes back in all directions, as much as Kulla and Conty say. Brushed surfaces have a table of their own.
#include "light/facets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

double slant(double cosine, double a2) {
  return std::sqrt(cosine * cosine * (1.0 - a2) + a2);
}

/// As a direction's slant, of facets that are wider across than along.
double slant(const Vec3& direction, const Widths& w) {
  return std::sqrt(w.along * w.along * direction.x() * direction.x() +
                   w.across * w.across * direction.y() * direction.y() + direction.z() * direction.z());
}

/// Share of light from a direction that leaves after one facet: the mean of G2 / G1 over the facets that the direction
/// sees (Heitz 2018, "Sampling the GGX distribution of visible normals"), by steps * steps of them, most of
/// them steep: light is lost there.
double single(const Vec3& in, const Widths& w, int steps) {
  const Vec3 stretched = Vec3(w.along * in.x(), w.across * in.y(), in.z()).normalized();
  const double flat = std::hypot(in.x(), in.y());
  const Vec3 along = flat > 0.0 ? Vec3(Vec3(-stretched.y(), stretched.x(), 0.0).normalized()) : Vec3(Vec3::UnitY());
  const Vec3 up = stretched.cross(along);
  const double own = slant(in, w);
  double sum = 0.0, weights = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double left = 1.0 - (i + 0.5) / steps, radius = std::sqrt(1.0 - left * left * left);
    weights += left * left;
    for (int k = 0; k < steps; ++k) {
      const double turn = 2.0 * M_PI * (k + 0.5) / steps, x = radius * std::cos(turn), s = 0.5 * (1.0 + stretched.z());
      const double y = (1.0 - s) * std::sqrt(1.0 - x * x) + s * radius * std::sin(turn);
      const Vec3 seen = x * along + y * up + std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * stretched;
      const Vec3 facet = Vec3(w.along * seen.x(), w.across * seen.y(), std::max(0.0, seen.z())).normalized();
      const Vec3 out = 2.0 * in.dot(facet) * facet - in;
      if (out.z() <= 0.0) continue;
      sum += left * left * out.z() * (in.z() + own) / (in.z() * slant(out, w) + out.z() * own);
    }
  }
  return sum / (weights * steps);
}

/// single() over roughness (square root of alpha) and the square root of the cosine, where it bends most, and its mean
/// over the hemisphere.
class ReflectanceTable {
 public:
  ReflectanceTable() {
    for (int r = 0; r <= roughnesses; ++r) {
      const double roughness = static_cast<double>(r) / roughnesses, alpha = std::max(roughness * roughness, 1e-3);
      for (int c = 0; c <= cosines; ++c) {
        const double root = static_cast<double>(c) / cosines;
        const double cosine = std::max(root * root, 1e-4);
        values_[r][c] = single(Vec3(std::sqrt(1.0 - cosine * cosine), 0.0, cosine), {alpha, alpha}, 32);
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

double aspect_of(double anisotropy) {
  return std::sqrt(1.0 - 0.9 * anisotropy);
}

Widths widths_of(double roughness, double aspect) {
  const double alpha = roughness * roughness;
  return {std::max(alpha * aspect, 1e-3), std::clamp(alpha / aspect, 1e-3, 1.0)};
}

/// single() of brushed surfaces over the logarithm of the aspect, roughness, the square root of the cosine, and the
/// angle to the lines.
class BrushedTable {
 public:
  BrushedTable() {
    for (int a = 0; a <= aspects; ++a) {
      for (int r = 0; r <= roughnesses; ++r) {
        const Widths w =
            widths_of(static_cast<double>(r) / roughnesses, std::pow(aspect_of(1.0), static_cast<double>(a) / aspects));
        for (int c = 0; c <= cosines; ++c) {
          const double cosine = std::max(std::pow(static_cast<double>(c) / cosines, 2), 1e-4);
          const double sine = std::sqrt(1.0 - cosine * cosine);
          for (int t = 0; t <= turns; ++t) {
            const double turn = 0.5 * M_PI * t / turns;
            values_[a][r][c][t] = single(Vec3(sine * std::cos(turn), sine * std::sin(turn), cosine), w, 16);
          }
        }
        means_[a][r] = mean_of(values_[a][r]);
      }
    }
  }
  double at(double roughness, double anisotropy, const Vec3& direction) const {
    return over(place_of(anisotropy), aspects, [&](int a) {
      return over(roughness, roughnesses, [&](int r) { return in_layer(values_[a][r], direction); });
    });
  }
  double mean(double roughness, double anisotropy) const {
    return over(place_of(anisotropy), aspects,
                [&](int a) { return over(roughness, roughnesses, [&](int r) { return means_[a][r]; }); });
  }

 private:
  static double place_of(double anisotropy) { return std::log(aspect_of(anisotropy)) / std::log(aspect_of(1.0)); }
  static constexpr int aspects = 8, roughnesses = 16, cosines = 12, turns = 6;
  using Layer = std::array<std::array<double, turns + 1>, cosines + 1>;
  template <class Value>
  static double over(double place, int steps, const Value& value) {
    const int i = std::min(static_cast<int>(place * steps), steps - 1);
    const double share = place * steps - i, low = value(i);
    return share > 0.0 ? low + share * (value(i + 1) - low) : low;
  }
  static double in_layer(const Layer& layer, const Vec3& direction) {
    const double turn = std::atan2(std::abs(direction.y()), std::abs(direction.x())) / (0.5 * M_PI);
    return over(std::sqrt(std::min(direction.z(), 1.0)), cosines, [&](int c) {
      return over(turn, turns, [&](int t) { return layer[static_cast<std::size_t>(c)][static_cast<std::size_t>(t)]; });
    });
  }
  /// Over a hemisphere of even light.
  static double mean_of(const Layer& layer) {
    constexpr int fine = 64;
    double sum = 0.0;
    for (int i = 0; i < fine; ++i) {
      const double root = (i + 0.5) / fine, c = root * root, s = std::sqrt(1.0 - c * c);
      for (int k = 0; k < fine; ++k) {
        const double turn = 0.5 * M_PI * (k + 0.5) / fine;
        sum += in_layer(layer, Vec3(s * std::cos(turn), s * std::sin(turn), c)) * 4.0 * root * c / (fine * fine);
      }
    }
    return sum;
  }
  std::array<std::array<Layer, roughnesses + 1>, aspects + 1> values_;
  std::array<std::array<double, roughnesses + 1>, aspects + 1> means_;
};

/// Light that met one facet and light that met several (Kulla and Conty), over that on a white matte surface that faces
/// the light. Each facet more takes its share again.
double both(double single, double again, double mean, double once, double often) {
  if (once == 1.0 && often == 1.0) return single + again;
  const double lost = std::max(1.0 - mean, 1e-6);
  return single * once + again * (often * often * mean / (1.0 - often * lost));
}

}  // namespace

Widths widths_of(const Surface& surface) {
  return widths_of(surface.roughness, aspect_of(surface.anisotropy));
}

std::optional<Mat3> frame_along(const Surface& surface, const Vec3& normal) {
  if (surface.anisotropy <= 0.0) return std::nullopt;
  const Vec3 along = surface.along - normal * normal.dot(surface.along);
  if (!(along.norm() > 1e-3 * surface.along.norm())) return std::nullopt;
  Mat3 frame;
  frame.col(0) = along.normalized();
  frame.col(1) = normal.cross(frame.col(0));
  frame.col(2) = normal;
  return frame;
}

double brushed_lobe(const Surface& surface, const Vec3& in, const Vec3& out, double once, double often) {
  static const BrushedTable table;
  const Widths w = widths_of(surface);
  const Vec3 half = (in + out).normalized();
  const double bend = Vec3(half.x() / w.along, half.y() / w.across, half.z()).squaredNorm();
  const double facets = 1.0 / (M_PI * w.along * w.across * bend * bend);
  const double visible = 0.5 / (in.z() * slant(out, w) + out.z() * slant(in, w));
  const double mean = table.mean(surface.roughness, surface.anisotropy), lost = std::max(1.0 - mean, 1e-6);
  const double again = (1.0 - table.at(surface.roughness, surface.anisotropy, in)) *
                       (1.0 - table.at(surface.roughness, surface.anisotropy, out)) / lost;
  return both(M_PI * facets * visible, again, mean, once, often) * in.z();
}

double facet_lobe(double alpha, double in, double out, double half, double once, double often) {
  static const ReflectanceTable table;
  const double a2 = alpha * alpha, bend = half * half * (a2 - 1.0) + 1.0, roughness = std::sqrt(alpha);
  const double facets = a2 / (M_PI * bend * bend);
  const double visible = 0.5 / (in * slant(out, a2) + out * slant(in, a2));
  const double mean = table.mean(roughness), lost = std::max(1.0 - mean, 1e-6);
  const double again = (1.0 - table.at(roughness, in)) * (1.0 - table.at(roughness, out)) / lost;
  return both(M_PI * facets * visible, again, mean, once, often) * in;
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
