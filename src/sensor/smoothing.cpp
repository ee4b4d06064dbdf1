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

constexpr double invalid = -1e9;  // 1/m: so far off each plane that it counts nothing

/// 1 / depth (1/m) about a pixel, and its growth to the next one.
struct Plane {
  double here, right, down;
};

/// Weighted sums over a window, of residuals r at places (u, v).
struct Sums {
  double n = 0.0, u = 0.0, v = 0.0, r = 0.0, uu = 0.0, uv = 0.0, vv = 0.0, ur = 0.0, vr = 0.0;
  void add(double w, double x, double residual) {
    n += w, u += w * x, uu += w * x * x;
    r += w * residual, ur += w * x * residual;
  }
  /// Of a row, whose places have one v.
  void add(const Sums& row, double y) {
    n += row.n, u += row.u, uu += row.uu, r += row.r, ur += row.ur;
    v += y * row.n, vv += y * y * row.n, uv += y * row.u, vr += y * row.r;
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
    for (const float z : image.depth) inverse_.push_back(std::isnan(z) ? invalid : 1.0 / static_cast<double>(z));
    for (int v = -reach_; v <= reach_; ++v)
      for (int u = -reach_; u <= reach_; ++u)
        weights_.push_back(std::exp(-0.5 * (u * u + v * v) / (settings.sigma * settings.sigma)));
  }

  /// Depth (m) of a pixel that has one. The second plane is free of the noise of the first one's slopes.
  double smoothed(int x, int y) const {
    Plane plane{at(x, y), slope(x, y, 1, 0), slope(x, y, 0, 1)};
    for (int k = 0; k < 2; ++k) plane = fitted(plane, x, y);
    return 1.0 / (plane.here > 0.0 ? plane.here : at(x, y));  // a step of metres may lean it behind the camera
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
      if (at(u, v) == invalid || (known && std::abs(growth) >= std::abs(smaller))) continue;
      smaller = growth;
      known = true;
    }
    return smaller;
  }

  /// The range kernel is Tukey's biweight: what lies `step` off the plane counts nothing.
  Plane fitted(const Plane& plane, int x, int y) const {
    const double steps = 1.0 / (plane.here * plane.here * step_);  // of depth, by the growth of 1 / depth
    Sums sums;
    for (int v = std::max(-reach_, -y); v <= std::min(reach_, height_ - 1 - y); ++v) {
      Sums sum;
      const double* const row = &inverse_[static_cast<std::size_t>(y + v) * width_];
      const double* const weights = &weights_[static_cast<std::size_t>((v + reach_) * (2 * reach_ + 1) + reach_)];
      for (int u = std::max(-reach_, -x); u <= std::min(reach_, width_ - 1 - x); ++u) {
        const double residual = row[x + u] - (plane.here + plane.right * u + plane.down * v), off = steps * residual;
        const double near = std::max(0.0, 1.0 - off * off);
        sum.add(weights[u] * near * near, u, residual);
      }
      sums.add(sum, v);
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
