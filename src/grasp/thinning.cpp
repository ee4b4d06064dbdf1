/// Poses are thinned by a sequence of covers, each finer than the one before, so that a larger number of poses always
/// contains a smaller one.
#include "grasp/thinning.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr double growth = 1.2;            ///< ratio of the limits of one cover and of the next finer one
constexpr double coarsest = 33.0;         ///< limits of the first cover, in units of the given ones
constexpr std::size_t ball_images = 300;  ///< number of turns of a ball

/// A turn of an even spread over all (Alexa 2022, "Super-Fibonacci spirals").
Quat spread_turn(std::size_t i, std::size_t count) {
  constexpr double phi = 1.4142135623730951, psi = 1.533751168755204288118041;
  const double s = static_cast<double>(i) + 0.5, t = s / static_cast<double>(count);
  const double alpha = 2.0 * M_PI * s / phi, beta = 2.0 * M_PI * s / psi;
  const double r = std::sqrt(t), q = std::sqrt(1.0 - t);
  return Quat(q * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), q * std::sin(beta)).normalized();
}

Pose turned_about(const Pose& pose, const Quat& turn, const Vec3& center) {
  return {center + turn * (pose.position - center), (turn * pose.orientation).normalized()};
}

}  // namespace

PoseMeasure::PoseMeasure(const Symmetries& symmetries, Gripper::Type type)
    : maps_(1), axes_(symmetries.continuous), type_(type) {
  maps_.insert(maps_.end(), symmetries.discrete.begin(), symmetries.discrete.end());
}

double PoseMeasure::angle_between(const Quat& a, const Quat& b) const {
  if (type_ == Gripper::Type::suction) {  // round
    const double cosine = (a * Vec3::UnitZ()).dot(b * Vec3::UnitZ());
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  // Turned by half about z, the fingers have changed places.
  const Quat between = a.conjugate() * b;
  return 2.0 * std::acos(std::clamp(std::max(std::abs(between.w()), std::abs(between.z())), 0.0, 1.0));
}

/// The turn about the axis that brings four points of gripper b nearest to those of a; `arm` weighs angles (m/rad).
Quat PoseMeasure::about_axis(const Pose& a, const Pose& b, double arm) const {
  const Vec3& axis = axes_[0].direction;
  const auto flat = [&](const Vec3& x) { return Vec3(x - axis.dot(x) * axis); };
  const auto sums = [&](double flip) {
    double cosine = 0.0, sine = 0.0;
    const auto add = [&](const Vec3& to, const Vec3& from) {
      cosine += flat(from).dot(flat(to));
      sine += axis.dot(flat(from).cross(flat(to)));
    };
    add(a.position - axes_[0].point, b.position - axes_[0].point);
    add(arm * (a.orientation * Vec3::UnitZ()), arm * (b.orientation * Vec3::UnitZ()));
    if (type_ == Gripper::Type::parallel)
      add(arm * (a.orientation * Vec3::UnitX()), flip * arm * (b.orientation * Vec3::UnitX()));
    return Eigen::Vector2d(cosine, sine);
  };
  const Eigen::Vector2d plain = sums(1.0), flipped = sums(-1.0);
  const Eigen::Vector2d& best = plain.squaredNorm() >= flipped.squaredNorm() ? plain : flipped;
  return Quat(Eigen::AngleAxisd(std::atan2(best.y(), best.x()), axis));
}

double PoseMeasure::distance(const Pose& a, const Pose& b, const Limits& limits, double enough) const {
  if (axes_.size() > 1) {  // a ball: only the position of its centre in the gripper's frame matters
    Vec3 here = a.inverse() * axes_[0].point, there = b.inverse() * axes_[0].point;
    if (type_ == Gripper::Type::suction) {
      here = Vec3(here.head<2>().norm(), 0.0, here.z());
      there = Vec3(there.head<2>().norm(), 0.0, there.z());
    }
    const Vec3 flipped(-there.x(), -there.y(), there.z());
    return std::min((here - there).norm(), (here - flipped).norm()) / limits.apart;
  }
  double least = enough;
  for (const Pose& map : maps_) {
    Pose there = map * b;
    if (!axes_.empty()) there = turned_about(there, about_axis(a, there, limits.apart / limits.angle), axes_[0].point);
    const double apart = (a.position - there.position).norm() / limits.apart;
    if (apart < least)
      least = std::min(least, std::max(apart, angle_between(a.orientation, there.orientation) / limits.angle));
  }
  return least;
}

std::vector<Pose> PoseMeasure::mapped(const Pose& a) const {
  std::vector<Pose> all;
  if (!axes_.empty()) return all;
  for (const Pose& map : maps_) all.push_back(map.inverse() * a);
  return all;
}

double PoseMeasure::plain_distance(const std::vector<Pose>& mapped, const Pose& b, const Limits& limits,
                                   double enough) const {
  double least = enough;
  for (const Pose& a : mapped) {
    const double squared = (a.position - b.position).squaredNorm() / (limits.apart * limits.apart);
    if (squared >= least * least) continue;
    least = std::min(least, std::max(std::sqrt(squared), angle_between(a.orientation, b.orientation) / limits.angle));
  }
  return least;
}

std::vector<Pose> PoseMeasure::images(const Pose& pose, const Limits& limits) const {
  std::vector<Pose> all;
  if (axes_.size() > 1) {
    all.push_back(pose);
    for (std::size_t i = 0; i < ball_images; ++i)
      all.push_back(turned_about(pose, spread_turn(i, ball_images), axes_[0].point));
    return all;
  }
  for (const Pose& map : maps_) {
    const Pose mapped = map * pose;
    if (axes_.empty()) {
      all.push_back(mapped);
      continue;
    }
    const Vec3 arm = (mapped.position - axes_[0].point).cross(axes_[0].direction);
    const double step = std::min(limits.angle, limits.apart / std::max(arm.norm(), 1e-12));
    const int steps = std::clamp(static_cast<int>(std::ceil(2.0 * M_PI / step)), 1, 72);
    for (int i = 0; i < steps; ++i)
      all.push_back(
          turned_about(mapped, Quat(Eigen::AngleAxisd(2.0 * M_PI * i / steps, axes_[0].direction)), axes_[0].point));
  }
  return all;
}

std::vector<std::size_t> thin(const std::vector<Pose>& poses, const PoseMeasure& measure,
                              const PoseMeasure::Limits& limits, std::size_t most) {
  std::vector<double> distance(poses.size(), std::numeric_limits<double>::infinity());  // from those chosen
  std::vector<std::size_t> left(poses.size()), chosen;
  std::iota(left.begin(), left.end(), std::size_t{0});
  for (double cover = coarsest; !left.empty() && chosen.size() < most; cover = std::max(1.0, cover / growth)) {
    for (std::size_t at = 0; at < left.size() && chosen.size() < most; ++at) {
      if (distance[left[at]] < cover) continue;
      if (chosen.size() % 64 == 0) stop_if_cancelled();
      const Pose& next = poses[left[at]];
      chosen.push_back(left[at]);
      const std::vector<Pose> mapped = measure.mapped(next);
      for (const std::size_t i : left)
        distance[i] = mapped.empty() ? measure.distance(next, poses[i], limits, distance[i])
                                     : measure.plain_distance(mapped, poses[i], limits, distance[i]);
    }
    left.erase(std::remove_if(left.begin(), left.end(), [&](std::size_t i) { return distance[i] < 1.0; }), left.end());
  }
  return chosen;
}

}  // namespace bin_scenes
