/// A bilateral filter (Tomasi, Manduchi 1998, "Bilateral filtering for gray and color images") about the local plane,
/// as in Choudhury, Tumblin 2003, "The trilateral filter for high contrast images and meshes": a mean of raw depth
/// would leave out the pixels of a tilted plane. It works on 1 / depth, of which a plane is linear in the pixels.
#include "sensor/smoothing.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace bin_scenes {

namespace {

/// 1 / depth (1/m) about a pixel, and its growth to the next one.
struct Plane {
  double here, right, down;
};

/// Weighted sums over a window, of residuals r at places (u, v).
struct Sums {
  double n = 0.0, u = 0.0, v = 0.0, r = 0.0, uu = 0.0, uv = 0.0, vv = 0.0, ur = 0.0, vr = 0.0;
  void add(double w, double x, double y, double residual) {
    n += w, u += w * x, v += w * y, r += w * residual;
    uu += w * x * x, uv += w * x * y, vv += w * y * y;
    ur += w * x * residual, vr += w * y * residual;
  }
};

/// The plane moved and turned to have the least squares of residuals; only moved if all lie in a line.
Plane corrected(const Plane& plane, const Sums& s) {
  constexpr double in_a_line = 1e-3;  // pixel^4
  const double mu = s.u / s.n, mv = s.v / s.n, mr = s.r / s.n;
  const double uu = s.uu / s.n - mu * mu, uv = s.uv / s.n - mu * mv, vv = s.vv / s.n - mv * mv;
  const double ur = s.ur / s.n - mu * mr, vr = s.vr / s.n - mv * mr;
  const double det = uu * vv - uv * uv;
  if (!(det > in_a_line)) return {plane.here + mr, plane.right, plane.down};
  const double right = (ur * vv - vr * uv) / det, down = (vr * uu - ur * uv) / det;
  return {plane.here + mr - right * mu - down * mv, plane.right + right, plane.down + down};
}

class Smoother {
 public:
  Smoother(const SmoothingFilter& settings, const RangeImage& image)
      : step_(settings.step), width_(image.width), height_(image.height), reach_(reach_of(settings.sigma)) {
    for (const float z : image.depth) inverse_.push_back(1.0 / static_cast<double>(z));
    for (int v = -reach_; v <= reach_; ++v)
      for (int u = -reach_; u <= reach_; ++u)
        weights_.push_back(std::exp(-0.5 * (u * u + v * v) / (settings.sigma * settings.sigma)));
  }

  /// Depth (m) of a pixel that has one. The second plane is free of the noise of the first one's slopes.
  double smoothed(int x, int y) const {
    Plane plane{at(x, y), slope(x, y, 1, 0), slope(x, y, 0, 1)};
    for (int k = 0; k < 2; ++k) plane = fitted(plane, x, y);
    return 1.0 / plane.here;
  }

 private:
  static int reach_of(double sigma) { return static_cast<int>(std::ceil(3.0 * sigma)); }
  double at(int x, int y) const { return inverse_[static_cast<std::size_t>(y) * width_ + x]; }

  /// Growth of 1 / depth to a neighbour: the smaller one of both sides, since one of them may lie beyond an edge.
  double slope(int x, int y, int right, int down) const {
    double smaller = 0.0;
    bool known = false;
    for (const int side : {-1, 1}) {
      const int u = x + side * right, v = y + side * down;
      if (u < 0 || v < 0 || u >= width_ || v >= height_) continue;
      const double growth = side * (at(u, v) - at(x, y));
      if (std::isnan(growth) || (known && std::abs(growth) >= std::abs(smaller))) continue;
      smaller = growth;
      known = true;
    }
    return smaller;
  }

  /// The range kernel is Tukey's biweight: what lies `step` off the plane counts nothing, and takes no time.
  Plane fitted(const Plane& plane, int x, int y) const {
    Sums sums;
    for (int v = std::max(-reach_, -y); v <= std::min(reach_, height_ - 1 - y); ++v) {
      const double* const row = &inverse_[static_cast<std::size_t>(y + v) * width_];
      const double* const weights = &weights_[static_cast<std::size_t>((v + reach_) * (2 * reach_ + 1) + reach_)];
      for (int u = std::max(-reach_, -x); u <= std::min(reach_, width_ - 1 - x); ++u) {
        const double value = row[x + u], expected = plane.here + plane.right * u + plane.down * v;
        const double off = (value - expected) / (value * expected * step_);  // of depth, in steps
        const double near = 1.0 - off * off;
        if (!(near > 0.0)) continue;  // an invalid pixel's is no number
        sums.add(weights[u] * near * near, u, v, value - expected);
      }
    }
    return sums.n > 0.0 ? corrected(plane, sums) : plane;
  }

  double step_;
  int width_, height_, reach_;
  std::vector<double> inverse_;  ///< 1/m
  std::vector<double> weights_;  ///< of places in the window
};

}  // namespace

void smooth(const SmoothingFilter& settings, RangeImage& image) {
  const Smoother smoother(settings, image);
  const auto width = static_cast<std::size_t>(image.width);
  in_parallel(static_cast<std::size_t>(image.height), [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      float& depth = image.depth[y * width + x];
      if (!std::isnan(depth)) depth = static_cast<float>(smoother.smoothed(static_cast<int>(x), static_cast<int>(y)));
    }
  });
}

}  // namespace bin_scenes
