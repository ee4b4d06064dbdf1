#include "pour/lying.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/hull_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

LyingPoses::LyingPoses(const PartModel& part) {
  const Mesh hull = convex_hull(part.corners(), std::numeric_limits<int>::max());
  const Vec3& center = part.mass().center;
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    const Vec3 area = hull.area_vector(t);
    if (!(area.norm() > 0.0)) continue;
    Face face{area.normalized(), 0.0};
    // Over all vertices, because the normal of a sliver may point anywhere: its plane then touches the hull elsewhere.
    for (const Vec3& vertex : hull.vertices) face.distance = std::max(face.distance, face.normal.dot(vertex - center));
    faces_.push_back(face);
  }
  BIN_SCENES_ASSERT(!faces_.empty());
}

const LyingPoses::Face& LyingPoses::face_towards(const Vec3& direction) const {
  const auto reach = [&](const Face& face) {
    const double along = face.normal.dot(direction);
    return along > 0.0 ? face.distance / along : std::numeric_limits<double>::infinity();
  };
  return *std::min_element(faces_.begin(), faces_.end(),
                           [&](const Face& a, const Face& b) { return reach(a) < reach(b); });
}

Quat LyingPoses::draw(Random& random) const {
  const Quat start = random.orientation();
  const Face* face = &face_towards(start.conjugate() * -Vec3::UnitZ());
  // A part topples where the foot of its centre of mass is beside the face, and the centre of mass sinks.
  for (const Face* next = &face_towards(face->normal); next->distance < face->distance * (1.0 - 1e-12);
       next = &face_towards(face->normal))
    face = next;
  return (Quat::FromTwoVectors(start * face->normal, -Vec3::UnitZ()) * start).normalized();
}

Footprint footprint(const PartModel& part, const Pose& pose) {
  Footprint circle{(pose * part.mass().center).head<2>(), 0.0};
  for (const Vec3& corner : part.corners())
    circle.radius = std::max(circle.radius, ((pose * corner).head<2>() - circle.center).norm());
  return circle;
}

std::optional<Pose> place_on_table(const PartModel& part, const LyingPoses& lying, const Aabb& bin, double height,
                                   double strip, const std::vector<Footprint>& others, Random& random) {
  constexpr int tries = 200;
  Pose pose{Vec3::Zero(), lying.draw(random)};
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : part.corners()) lowest = std::min(lowest, (pose * corner).z());
  pose.position = Vec3(0.0, 0.0, height - lowest);
  Footprint circle = footprint(part, pose);
  const Eigen::Vector2d offset = circle.center, reach = Eigen::Vector2d::Constant(circle.radius + strip);
  const Eigen::Vector2d lower = bin.lower.head<2>() - reach, upper = bin.upper.head<2>() + reach;
  for (int t = 0; t < tries; ++t) {
    const double u = random.uniform(), v = random.uniform();
    circle.center = lower + Eigen::Vector2d(u, v).cwiseProduct(upper - lower);
    const Eigen::Vector2d beside =
        (bin.lower.head<2>() - circle.center).cwiseMax(circle.center - bin.upper.head<2>()).cwiseMax(0.0);
    const double distance = beside.norm() - circle.radius;
    if (distance < 0.0 || distance > strip) continue;
    const auto overlaps = [&](const Footprint& other) {
      return (other.center - circle.center).norm() < other.radius + circle.radius;
    };
    if (std::any_of(others.begin(), others.end(), overlaps)) continue;
    pose.position.head<2>() = circle.center - offset;
    return pose;
  }
  return std::nullopt;
}

}  // namespace bin_scenes
