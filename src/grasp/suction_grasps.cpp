/// A cup is set on the surface along its normal. Rays along its axis measure the heights of the surface below the ring
/// and within it. The bellows compensates the tilt of a plane through the heights below the ring, and the lip the
/// residual (Mahler et al. 2018, "Dex-Net 3.0"; Cao et al. 2021, "SuctionNet-1Billion", which scores seals by that
/// residual).
#include "grasp/suction_grasps.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "grasp/gripper_shape.hpp"
#include "grasp/rays.hpp"
#include "grasp/surface_points.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr std::size_t cups_tried = 5000;
constexpr int ring_rays = 24, ring_contacts = 8;
constexpr int margin_rays = 96;    ///< an edge between two rays may be nearer than they find, by 0.1 % of the radius
constexpr double rounding = 1e-5;  ///< / diagonal
constexpr double wide = 0.5;       ///< / radius: margins are measured up to this value
constexpr int margin_steps = 4;

/// Surface below the ring and inside it, along the cup's axis.
struct Footprint {
  std::array<double, ring_rays> ring;  ///< m towards the cup
  double inner_low, inner_high;        ///< m, of points inside the ring
};

/// The plane through the heights below the ring, and the residuals.
struct Plane {
  double mean = 0.0, along_x = 0.0, along_y = 0.0;  ///< m: height, and amplitudes of the tilt
  double low = 0.0, high = 0.0;                     ///< m: smallest and largest residual
};

Vec3 on_ring(double radius, int i, int count) {
  const double angle = 2.0 * M_PI * i / count;
  return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
}

Plane plane_of(const Footprint& print) {
  Plane plane;
  for (int i = 0; i < ring_rays; ++i) {
    const Vec3 at = on_ring(1.0, i, ring_rays);
    plane.mean += print.ring[i] / ring_rays;
    plane.along_x += 2.0 * at.x() * print.ring[i] / ring_rays;
    plane.along_y += 2.0 * at.y() * print.ring[i] / ring_rays;
  }
  for (int i = 0; i < ring_rays; ++i) {
    const Vec3 at = on_ring(1.0, i, ring_rays);
    const double left = print.ring[i] - plane.mean - plane.along_x * at.x() - plane.along_y * at.y();
    plane.low = std::min(plane.low, left);
    plane.high = std::max(plane.high, left);
  }
  return plane;
}

class CupFitter {
 public:
  CupFitter(const PartModel& part, const Gripper& gripper)
      : part_(part), gripper_(gripper), above_(gripper.radius + gripper.travel()) {}

  /// None if there is no surface below a point of the ring or of its inside, at an edge or a hole.
  std::optional<Footprint> footprint(const Pose& pose) const {
    Footprint print;
    if (!ring(pose, gripper_.radius, print.ring)) return std::nullopt;
    print.inner_low = std::numeric_limits<double>::infinity();
    print.inner_high = -print.inner_low;
    constexpr int circle = 8;
    for (int i = 0; i <= 2 * circle; ++i) {
      const double radius = gripper_.radius * (i == 0 ? 0.0 : i <= circle ? 0.35 : 0.7);
      double found = 0.0;
      if (!height(pose, on_ring(radius, i, circle), found)) return std::nullopt;
      print.inner_low = std::min(print.inner_low, found);
      print.inner_high = std::max(print.inner_high, found);
    }
    return print;
  }

  /// Distance of the ring from edges and holes, at most the larger one of Gripper::margin and half the radius; negative
  /// if it is less than Gripper::margin. An edge is where there is no surface, or where it falls away more steeply than
  /// 45 degrees.
  double margin(const Pose& pose, const Footprint& print) const {
    const double asked = gripper_.margin, most = std::max(asked, wide * gripper_.radius);
    double found = asked > 0.0 ? -1.0 : 0.0;
    for (int step = asked > 0.0 ? 0 : 1; step <= margin_steps; ++step) {
      const double beyond = asked + step * (most - asked) / margin_steps;
      for (int i = 0; i < margin_rays; ++i) {
        double there = 0.0;
        if (!height(pose, on_ring(gripper_.radius + beyond, i, margin_rays), there)) return found;
        const int nearest = (i * ring_rays + margin_rays / 2) / margin_rays % ring_rays;
        if (print.ring[nearest] - there > gripper_.lip + beyond) return found;
      }
      found = beyond;
    }
    return found;
  }

 private:
  bool ring(const Pose& pose, double radius, std::array<double, ring_rays>& heights) const {
    for (int i = 0; i < ring_rays; ++i)
      if (!height(pose, on_ring(radius, i, ring_rays), heights[i])) return false;
    return true;
  }

  bool height(const Pose& pose, const Vec3& at, double& found) const {
    const Vec3 z = pose.orientation * Vec3::UnitZ();
    const auto passed = passages(part_.query(), pose * at - above_ * z, z, 0.0);
    if (passed.empty()) return false;
    found = above_ - passed.front().distance;
    return true;
  }

  const PartModel& part_;
  const Gripper& gripper_;
  double above_;
};

Pose facing(const Vec3& point, const Vec3& normal, const Mat3& principal) {
  int across = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(principal.col(i).dot(normal)) < std::abs(principal.col(across).dot(normal)) - 1e-9) across = i;
  const Vec3 z = -normal, x = (principal.col(across) - principal.col(across).dot(z) * z).normalized();
  Mat3 frame;
  frame << x, z.cross(x), z;
  return {point, Quat(frame).normalized()};
}

/// The pose, turned so that the plane through the heights below the ring is perpendicular to the axis of the cup.
Pose levelled(const Pose& pose, const Plane& plane, double radius, const Mat3& principal) {
  // Heights count against z: the surface's normal is (-slope, -1) in the cup's frame, towards the cup.
  const Vec3 normal = pose.orientation * Vec3(-plane.along_x / radius, -plane.along_y / radius, -1.0).normalized();
  return facing(pose.position, normal, principal);
}

std::vector<Vec3> ring_contacts_of(const Footprint& print, double radius, double crest) {
  std::vector<Vec3> points;
  for (int i = 0; i < ring_rays; i += ring_rays / ring_contacts) {
    Vec3 point = on_ring(radius, i, ring_rays);
    point.z() = crest - print.ring[i];
    points.push_back(point);
  }
  return points;
}

/// The cup at one point. It is turned so that the bellows has to compensate as little tilt as possible.
std::optional<Grasp> set_cup(const PartModel& part, const Gripper& g, const SpreadPoint& at, GraspCounts& counts) {
  const Mat3 principal = part.mass().principal_axes.toRotationMatrix();
  const CupFitter fitter(part, g);
  Pose pose = facing(at.point, at.normal, principal);
  auto print = fitter.footprint(pose);
  if (print) {
    pose = levelled(pose, plane_of(*print), g.radius, principal);
    print = fitter.footprint(pose);
  }
  if (!print) {
    ++counts.contact;
    return std::nullopt;
  }
  const Plane plane = plane_of(*print);
  Grasp grasp;
  grasp.gap = plane.high - plane.low;
  // A depression deeper than the radius counts as a hole that lets air in.
  const double tilt = 2.0 * std::hypot(plane.along_x, plane.along_y);
  if (grasp.gap > g.lip || tilt > g.travel() || print->inner_low < plane.mean - g.radius ||
      print->inner_high > plane.mean + g.travel() + grasp.gap) {
    ++counts.seal;
    return std::nullopt;
  }
  grasp.margin = fitter.margin(pose, *print);
  if (grasp.margin < 0.0) {
    ++counts.contact;
    return std::nullopt;
  }
  const double crest = plane.mean + plane.high + 0.5 * tilt;
  const Vec3 z = pose.orientation * Vec3::UnitZ();
  pose.position -= crest * z;
  grasp.pose = pose;
  grasp.radius = g.radius;
  const Vec3 offset = part.mass().center - pose.position;
  grasp.lever = (offset - offset.dot(z) * z).norm();
  grasp.contacts = ring_contacts_of(*print, g.radius, crest);
  // The cup is hollow: a surface that rises inside the ring is no obstacle.
  Pose raised = pose;
  raised.position -= (std::max(0.0, print->inner_high - crest) + rounding * part.diagonal()) * z;
  const Pose part_there = raised.inverse();
  for (const Sweep& sweep : approach_sweeps(g, {}, part.diagonal(), -0.5 * rounding * part.diagonal())) {
    if (!sweep.meets(part.query(), part_there)) continue;
    ++counts.collision;
    return std::nullopt;
  }
  ++counts.good;
  return grasp;
}

}  // namespace

std::vector<Grasp> suction_grasps(const PartModel& part, const Gripper& gripper, GraspCounts& counts) {
  std::vector<Grasp> grasps;
  for (const SpreadPoint& at : spread_points(part.mesh(), cups_tried)) {
    stop_if_cancelled();
    ++counts.tried;
    if (auto grasp = set_cup(part, gripper, at, counts)) grasps.push_back(*grasp);
  }
  return grasps;
}

}  // namespace bin_scenes
