/// How far a placed mesh may move along a direction before it touches another.
#include "bin_scenes/quality/quality.hpp"
#include "crossings.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

/// Whether an edge of a separates the shadows of both along z by more than rounding: neither meets the other on its
/// path then. Most pairs of triangles end here, at a tenth of the cost of triangle_distance().
bool edge_separates(const TrianglePoints& a, const TrianglePoints& b) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = a[(i + 1) % 3] - a[i];
    const auto side = [&](const Vec3& point) {
      return edge.x() * (point.y() - a[i].y()) - edge.y() * (point.x() - a[i].x());
    };
    const double inward = side(a[(i + 2) % 3]) < 0.0 ? -1.0 : 1.0;
    const double nearest = std::max({inward * side(b[0]), inward * side(b[1]), inward * side(b[2])});
    const double rounding = 1e-13 * edge.lpNorm<1>() * (a[i].lpNorm<1>() + b[0].lpNorm<1>() + b[1].lpNorm<1>());
    if (nearest < -rounding) return true;
  }
  return false;
}

/// How far s can move along `direction` before it meets t; infinite if it never does. Both are open at their rims, so
/// that parts sliding along each other do not hold each other.
double triangle_distance(const TrianglePoints& s, const TrianglePoints& t, const Vec3& direction) {
  // Heights of s over t at the corners of their common shadow; where they change sign, the two cut each other.
  double best = std::numeric_limits<double>::infinity();
  bool beyond = false;
  const auto add = [&](double distance) {
    if (distance < 0.0) {
      beyond = true;
    } else {
      best = std::min(best, distance);
    }
  };
  const auto corners = [&](const TrianglePoints& from, const TrianglePoints& to, const Vec3& along) {
    const Vec3 normal = (to[1] - to[0]).cross(to[2] - to[0]);
    const double slope = normal.dot(along);
    if (slope == 0.0) return;
    for (const Vec3& x : from) {
      const double distance = normal.dot(to[0] - x) / slope;
      const Vec3 hit = x + distance * along;
      bool over = true;
      for (int i = 0; i < 3; ++i) over = over && normal.cross(to[(i + 1) % 3] - to[i]).dot(hit - to[i]) > 0.0;
      if (over) add(distance);
    }
  };
  corners(s, t, direction);
  corners(t, s, -direction);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // s_i + k u + d direction = t_j + l v
      const Vec3 u = s[(i + 1) % 3] - s[i], v = t[(j + 1) % 3] - t[j], r = t[j] - s[i];
      const Vec3 side = u.cross(v);
      const double det = side.dot(direction);
      if (std::abs(det) <= 1e-12 * u.norm() * v.norm()) continue;
      const double k = r.cross(v).dot(direction) / det, l = r.cross(u).dot(direction) / det;
      if (k > 0.0 && k < 1.0 && l > 0.0 && l < 1.0) add(side.dot(r) / det);
    }
  }
  return beyond && best < std::numeric_limits<double>::infinity() ? 0.0 : best;
}

/// Boxes of a mesh's frame, and triangles, along a direction of the common frame.
class Extents {
 public:
  Extents(const Pose& pose, const Vec3& direction)
      : along_(pose.orientation.conjugate() * direction),
        size_(0.5 * along_.cwiseAbs()),
        shift_(pose.position.dot(direction)) {}
  double lowest(const Aabb& box) const { return shift_ + along_.dot(box.center()) - size_.dot(box.size()); }
  double highest(const Aabb& box) const { return shift_ + along_.dot(box.center()) + size_.dot(box.size()); }

 private:
  Vec3 along_, size_;
  double shift_;
};

/// Whether s is farther along the direction than t.
bool beyond(const TrianglePoints& s, const TrianglePoints& t, const Vec3& direction) {
  return std::min({direction.dot(s[0]), direction.dot(s[1]), direction.dot(s[2])}) >
         std::max({direction.dot(t[0]), direction.dot(t[1]), direction.dot(t[2])});
}

}  // namespace

double free_distance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b,
                     const Vec3& direction, double limit, const Vec3& guide) {
  BIN_SCENES_ASSERT(guide.dot(direction) >= 0.0);
  if (a.mesh().empty() || b.mesh().empty()) return limit;
  // Both in a frame with z against the direction, where a box's shadow is its x and y.
  const Quat upright = Quat::FromTwoVectors(-direction, Vec3::UnitZ());
  const auto stand = [&](const Pose& pose) { return Pose{upright * pose.position, upright * pose.orientation}; };
  const Pose stand_a = stand(pose_a), stand_b = stand(pose_b);
  const BoxMotion motion_a(stand_a), motion_b(stand_b);
  const Vec3 down = -Vec3::UnitZ();
  // What is beyond b along the guide moves away from it.
  const bool guided = !guide.isZero();
  const Extents along_a(pose_a, guide), along_b(pose_b, guide);
  const Vec3 upright_guide = upright * guide;
  double best = limit;
  const auto bound = [&](const Aabb& one, const Aabb& other) {
    const bool beside = (one.lower - other.upper).cwiseMax(other.lower - one.upper).head<2>().maxCoeff() > 0.0;
    if (beside || one.upper.z() < other.lower.z()) return std::numeric_limits<double>::infinity();
    return std::max(0.0, one.lower.z() - other.upper.z());
  };
  walk(
      a, stand_a, b, stand_b,
      [&](const Aabb& one, const Aabb& other) {
        if (guided && along_a.lowest(one) > along_b.highest(other)) return std::numeric_limits<double>::infinity();
        return bound(motion_a(one), motion_b(other));
      },
      [&] { return best; },
      [&](const Facet& s, const Facet& t) {
        if (!(bound(s.box, t.box) < best)) return;
        if (guided && beyond(s.points, t.points, upright_guide)) return;
        if (edge_separates(s.points, t.points) || edge_separates(t.points, s.points)) return;
        best = std::min(best, triangle_distance(s.points, t.points, down));
      });
  return best;
}

}  // namespace bin_scenes
