#include "bin_scenes/scene/motion.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

double smooth(double x) {
  const double in = std::clamp(x, 0.0, 1.0);
  return in * in * (3.0 - 2.0 * in);
}

using Coordinates = Eigen::Matrix<double, 7, 1>;

/// Cubic Hermite spline through the entries, the first of which is the start (Catmull and Rom 1974, for uneven times):
/// velocity is continuous, and none at both ends. Turns are interpolated as unit quaternions.
Pose on_path(const Motion& motion, double t) {
  const std::size_t count = motion.times.size() + 1;
  const auto time = [&](std::size_t k) { return k == 0 ? 0.0 : motion.times[k - 1]; };
  Coordinates previous = Coordinates::Unit(6);
  std::vector<Coordinates> knots = {previous};
  for (const Pose& pose : motion.poses) {
    Coordinates knot;
    knot << pose.position, pose.orientation.coeffs();
    if (knot.tail<4>().dot(previous.tail<4>()) < 0.0) knot.tail<4>() *= -1.0;  // the shorter arc
    knots.push_back(previous = knot);
  }
  const auto slope = [&](std::size_t k) -> Coordinates {
    if (k == 0 || k + 1 == count) return Coordinates::Zero();
    return (knots[k + 1] - knots[k - 1]) / (time(k + 1) - time(k - 1));
  };
  std::size_t k = 0;
  while (k + 2 < count && t >= time(k + 1)) ++k;
  const double span = time(k + 1) - time(k), s = std::clamp((t - time(k)) / span, 0.0, 1.0);
  const double rise = s * s * (3.0 - 2.0 * s);
  const Coordinates at =
      (1.0 - rise) * knots[k] + rise * knots[k + 1] + span * s * (1.0 - s) * ((1.0 - s) * slope(k) - s * slope(k + 1));
  Pose pose;
  pose.position = at.head<3>();
  pose.orientation.coeffs() = at.tail<4>().normalized();
  BIN_SCENES_ASSERT(is_rigid(pose));
  return pose;
}

}  // namespace

double Motion::duration() const {
  const double path = times.empty() ? 0.0 : times.back();
  return shake.isZero() && tilt.isZero() && belt.isZero() ? path : std::max(path, seconds);
}

Pose Motion::at(double t) const {
  BIN_SCENES_ASSERT(times.size() == poses.size() && ascends(times));
  Pose pose = times.empty() ? Pose() : on_path(*this, t);
  if ((shake.isZero() && tilt.isZero()) || t <= 0.0 || t >= seconds) return pose;
  const double sine = smooth(t * frequency) * smooth((seconds - t) * frequency) * std::sin(2.0 * M_PI * frequency * t);
  pose.position += sine * shake;
  if (!tilt.isZero())
    pose.orientation = Quat(Eigen::AngleAxisd(sine * tilt.norm(), tilt.normalized())) * pose.orientation;
  return pose;
}

}  // namespace bin_scenes
