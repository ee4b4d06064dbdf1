#include "sensor/models/triangulation.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

Triangulation::Triangulation(const Lens& projector, const Pose& projector_in_camera)
    : projector_(projector), distorted_(projector.distorts()) {
  const Pose camera = projector_in_camera.inverse();
  turn_ = camera.orientation.toRotationMatrix();
  origin_ = camera.position;
  const Vec3 row(projector.fx, projector.skew, projector.cx);
  share_ = turn_.transpose() * row;
  ahead_ = turn_.row(2).transpose();
  share_there_ = row.dot(origin_);
  ahead_there_ = origin_.z();
}

double Triangulation::depth(const Vec3& ray, double column) const {
  const Along a = along(ray);
  // share_there + z share = column (ahead_there + z depth)
  const auto on_plane = [&](double c) { return (c * ahead_there_ - share_there_) / (a.share - c * a.depth); };
  double z = on_plane(column);
  if (distorted_) {
    // The distorted column of where the plane is met gives by how much to move the plane; distortion varies slowly.
    const Vec3 direction = turn_ * ray;
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
  const bool in_front = z > 0.0 && ahead_there_ + z * a.depth > 0.0;
  return in_front ? z : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector2d Triangulation::slope(const Vec3& ray, double depth, const Vec3& normal, const Lens& camera) const {
  const Along a = along(ray);
  const double ahead = ahead_there_ + depth * a.depth, share = share_there_ + depth * a.share;
  const double facing = normal.dot(ray), scale = depth / (ahead * ahead);
  // On the face the next pixel's point lies off by depth * (step - ray * (normal . step) / facing).
  const auto passed = [&](int axis, double focal) {
    const double turn = normal[axis] / facing;
    return scale / focal * ((share_[axis] - turn * a.share) * ahead - share * (ahead_[axis] - turn * a.depth));
  };
  return {passed(0, camera.fx), passed(1, camera.fy)};
}

double Triangulation::depth_per_column(const Vec3& ray, double depth) const {
  if (!distorted_) {
    const Along a = along(ray);
    const double ahead = ahead_there_ + depth * a.depth, share = share_there_ + depth * a.share;
    return ahead * ahead / std::abs(a.share * ahead - share * a.depth);
  }
  const Vec3 direction = turn_ * ray;
  const double h = 1e-5 * depth;
  const auto a = projector_.project(origin_ + (depth - h) * direction);
  const auto b = projector_.project(origin_ + (depth + h) * direction);
  if (!a || !b) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * h / std::abs(b->x() - a->x());
}

}  // namespace bin_scenes
