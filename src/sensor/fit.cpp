#include "sensor/fit.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

Vec3 mean_of(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

}  // namespace

BallFit fit_ball(const std::vector<Vec3>& points) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  BallFit fit;
  if (points.size() < 4) return {Vec3::Constant(nan), nan, {}};
  // First by the linear form |p|^2 = 2 m p + c, then by Gauss-Newton on the distances themselves: the linear one weighs
  // them by themselves.
  const Vec3 about = mean_of(points);
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Vec3& p : points) {
    const Eigen::Vector4d row((p - about).x(), (p - about).y(), (p - about).z(), 1.0);
    normal += row * row.transpose();
    right += row * (p - about).squaredNorm();
  }
  const Eigen::Vector4d linear = normal.ldlt().solve(right);
  Vec3 center = 0.5 * linear.head<3>();
  double radius = std::sqrt(linear[3] + center.squaredNorm());
  for (int i = 0; i < 10; ++i) {
    normal.setZero();
    right.setZero();
    for (const Vec3& p : points) {
      const Vec3 arm = p - about - center;
      const double distance = arm.norm();
      const Eigen::Vector4d row(arm.x() / distance, arm.y() / distance, arm.z() / distance, 1.0);
      normal += row * row.transpose();
      right += row * (distance - radius);
    }
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    center += step.head<3>();
    radius += step[3];
    if (step.norm() < 1e-12) break;
  }
  fit.center = about + center;
  fit.radius = radius;
  for (const Vec3& p : points) fit.residuals.push_back((p - fit.center).norm() - radius);
  return fit;
}

PlaneFit fit_plane(const std::vector<Vec3>& points) {
  PlaneFit fit;
  if (points.size() < 3) return fit;
  fit.center = mean_of(points);
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) spread += (p - fit.center) * (p - fit.center).transpose();
  fit.normal = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(0);
  BIN_SCENES_ASSERT(is_unit(fit.normal) || !spread.allFinite());
  for (const Vec3& p : points) fit.residuals.push_back(fit.normal.dot(p - fit.center));
  return fit;
}

}  // namespace bin_scenes
