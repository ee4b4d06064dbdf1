#include "sensor/models/triangulation.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

Triangulation::Triangulation(const Lens& projector, const Pose& projector_in_camera)
    : projector_(projector), distorted_(projector.distorts()) {
  const Pose camera = projector_in_camera.inverse();
  turn_ = camera.orientation.toRotationMatrix();
  origin_ = camera.position;
}

double Triangulation::depth(const Vec3& ray, double column) const {
  const Vec3 direction = turn_ * ray;
  // Points of an undistorted column c lie in the plane fx x + skew y + (cx - c) z = 0.
  const auto on_plane = [&](double c) {
    const Vec3 plane(projector_.fx, projector_.skew, projector_.cx - c);
    return -plane.dot(origin_) / plane.dot(direction);
  };
  double z = on_plane(column);
  if (distorted_) {
    // The distorted column of where the plane is met tells by how much to move the plane; distortion varies slowly.
    double plane = column;
    for (int i = 0; i < 20; ++i) {
      const auto seen = projector_.project(origin_ + z * direction);
      if (!seen) break;
      const double error = column - seen->x();
      plane += error;
      z = on_plane(plane);
      if (std::abs(error) < 1e-9) break;
    }
  }
  const bool in_front = z > 0.0 && (origin_ + z * direction).z() > 0.0;
  return in_front ? z : std::numeric_limits<double>::quiet_NaN();
}

double Triangulation::columns_along(const Vec3& point, const Vec3& way) const {
  const Vec3 at = origin_ + turn_ * point, step = turn_ * way;
  return (projector_.fx * (step.x() * at.z() - at.x() * step.z()) +
          projector_.skew * (step.y() * at.z() - at.y() * step.z())) /
         (at.z() * at.z());
}

double Triangulation::depth_per_column(const Vec3& ray, double depth) const {
  if (!distorted_) return 1.0 / std::abs(columns_along(depth * ray, ray));
  const Vec3 direction = turn_ * ray;
  const double h = 1e-5 * depth;
  const auto a = projector_.project(origin_ + (depth - h) * direction);
  const auto b = projector_.project(origin_ + (depth + h) * direction);
  if (!a || !b) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * h / std::abs(b->x() - a->x());
}

}  // namespace bin_scenes
