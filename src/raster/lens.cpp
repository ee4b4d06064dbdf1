#include "bin_scenes/raster/lens.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/scene/request.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

using Vec2 = Eigen::Vector2d;

struct Distorted {
  Vec2 point;
  Eigen::Matrix2d slope;  // derivative of point by the undistorted coordinates
};

Distorted distort(const std::array<double, 5>& d, const Vec2& u) {
  const auto [k1, k2, p1, p2, k3] = d;
  const double x = u.x(), y = u.y(), r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);  // d radial / d r2
  Distorted out;
  out.point = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
               y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  const double across = 2.0 * x * y * slope + 2.0 * (p1 * x + p2 * y);
  out.slope << radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, across,  //
      across, radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return out;
}

/// Inside the first fold of the distortion, where it still maps one to one; checked along a line from the axis.
bool before_fold(const std::array<double, 5>& d, const Vec2& u) {
  constexpr int steps = 4;
  for (int i = 1; i <= steps; ++i) {
    if (!(distort(d, u * (static_cast<double>(i) / steps)).slope.determinant() > 0.0)) return false;
  }
  return true;
}

}  // namespace

bool Lens::distorts() const {
  return std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0.0; });
}

bool Lens::inside(const Vec2& pixel) const {
  return pixel.x() >= -0.5 && pixel.x() <= width - 0.5 && pixel.y() >= -0.5 && pixel.y() <= height - 0.5;
}

Vec3 Lens::ray(double column, double row) const {
  const double y = (row - cy) / fy;
  const Vec2 wanted((column - cx - skew * y) / fx, y);
  if (!distorts()) return {wanted.x(), wanted.y(), 1.0};
  Vec2 u = wanted;
  for (int i = 0; i < 30; ++i) {  // Newton; four or five steps do for a usual lens
    const Distorted now = distort(distortion, u);
    const Vec2 step = now.slope.inverse() * (wanted - now.point);
    if (!step.allFinite()) break;
    u += step;
    if (step.squaredNorm() < 1e-26) {
      if (before_fold(distortion, u)) return {u.x(), u.y(), 1.0};
      break;
    }
  }
  return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

std::optional<Vec2> Lens::project(const Vec3& point) const {
  if (!(point.z() > 0.0)) return std::nullopt;
  Vec2 p = point.head<2>() / point.z();
  if (distorts()) {
    if (!before_fold(distortion, p)) return std::nullopt;
    p = distort(distortion, p).point;
  }
  return Vec2(fx * p.x() + skew * p.y() + cx, fy * p.y() + cy);
}

Lens Lens::from_fov(int width, int height, double fov) {
  BIN_SCENES_ASSERT(width > 0 && height > 0 && fov > 0.0 && fov < M_PI);
  Lens lens;
  lens.width = width;
  lens.height = height;
  lens.fx = lens.fy = 0.5 * width / std::tan(0.5 * fov);
  lens.cx = 0.5 * (width - 1);
  lens.cy = 0.5 * (height - 1);
  return lens;
}

Lens lens_of(const Sensor& sensor) {
  const std::vector<double>& k = sensor.k;
  Lens lens;
  lens.width = sensor.width;
  lens.height = sensor.height;
  lens.fx = k.at(0), lens.skew = k.at(1), lens.cx = k.at(2);
  lens.fy = k.at(4), lens.cy = k.at(5);
  lens.distortion = sensor.distortion;
  return lens;
}

Lens lens_of(const Projector& projector) {
  Lens lens = Lens::from_fov(projector.width, projector.height, projector.fov);
  lens.distortion = projector.distortion;
  return lens;
}

}  // namespace bin_scenes
