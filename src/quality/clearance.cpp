/// Exact distances between placed meshes: the shortest one, and the one along a direction.
#include "bin_scenes/quality/quality.hpp"
#include "crossings.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

constexpr double touching = 1e-9;  // relative to the smaller diagonal: lengths that rounding makes

/// Squared distance of two segments (Ericson 2005, "Real-Time Collision Detection", section 5.1.9).
double segment_distance2(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const auto clamp = [](double x) { return std::min(1.0, std::max(0.0, x)); };
  const Vec3 r = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), f = v.dot(r), c = u.dot(r), b = u.dot(v);
  double s = 0.0, t = 0.0;
  if (a > 0.0 && e > 0.0) {
    const double det = a * e - b * b;
    s = det > 0.0 ? clamp((b * f - c * e) / det) : 0.0;
    t = (b * s + f) / e;
    if (t < 0.0) {
      t = 0.0;
      s = clamp(-c / a);
    } else if (t > 1.0) {
      t = 1.0;
      s = clamp((b - c) / a);
    }
  } else if (a > 0.0) {
    s = clamp(-c / a);
  } else if (e > 0.0) {
    t = clamp(f / e);
  }
  return (r + s * u - t * v).squaredNorm();
}

/// Squared distances of the corners of s from t, of those that lie over it.
double corner_distance2(const TrianglePoints& s, const Facet& facet) {
  const TrianglePoints& t = facet.points;
  double best = std::numeric_limits<double>::infinity();
  if (facet.normal.isZero()) return best;
  for (const Vec3& x : s) {
    bool over = true;
    for (int i = 0; i < 3; ++i) over = over && facet.normal.cross(t[(i + 1) % 3] - t[i]).dot(x - t[i]) >= 0.0;
    if (!over) continue;
    const double height = facet.normal.dot(x - t[0]);
    best = std::min(best, height * height);
  }
  return best;
}

double triangle_distance(const Facet& one, const Facet& other, double tolerance) {
  if (crossing(one, other, tolerance)) return 0.0;
  const TrianglePoints &s = one.points, &t = other.points;
  double best = std::min(corner_distance2(s, other), corner_distance2(t, one));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      best = std::min(best, segment_distance2(s[i], s[(i + 1) % 3] - s[i], t[j], t[(j + 1) % 3] - t[j]));
    }
  }
  return std::sqrt(best);
}

/// How far s can move along `way` before it meets t; infinite if it never does. Both are open at their rims, so that
/// parts sliding along each other do not hold each other.
double triangle_way(const TrianglePoints& s, const TrianglePoints& t, const Vec3& way) {
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
  corners(s, t, way);
  corners(t, s, -way);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // s_i + k u + d way = t_j + l v
      const Vec3 u = s[(i + 1) % 3] - s[i], v = t[(j + 1) % 3] - t[j], r = t[j] - s[i];
      const Vec3 side = u.cross(v);
      const double det = side.dot(way);
      if (std::abs(det) <= 1e-12 * u.norm() * v.norm()) continue;
      const double k = r.cross(v).dot(way) / det, l = r.cross(u).dot(way) / det;
      if (k > 0.0 && k < 1.0 && l > 0.0 && l < 1.0) add(side.dot(r) / det);
    }
  }
  return beyond && best < std::numeric_limits<double>::infinity() ? 0.0 : best;
}

bool contains(const MeshQuery& outer, const Pose& to_outer, const MeshQuery& inner) {
  const Mesh& mesh = inner.mesh();
  return outer.inside(to_outer * mesh.vertices[mesh.triangles[0][0]]);
}

}  // namespace

double clearance(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, double limit) {
  if (a.mesh().empty() || b.mesh().empty()) return limit;
  const Pose b_in_a = pose_a.inverse() * pose_b, a_in_b = b_in_a.inverse();
  const BoxMotion to_a(b_in_a), to_b(a_in_b);
  const Aabb &box_a = a.nodes()[0].box, &box_b = b.nodes()[0].box;
  const double tolerance = touching * std::min(box_a.diagonal(), box_b.diagonal());
  double best = limit;
  walk(
      a, Pose(), b, b_in_a,
      [&](const Aabb& one, const Aabb& other) {
        const double distance = box_distance(one, to_a(other));
        return distance >= best ? distance : std::max(distance, box_distance(to_b(one), other));
      },
      [&] { return best; },
      [&](const Facet& s, const Facet& t) {
        if (box_distance(s.box, t.box) < best) best = std::min(best, triangle_distance(s, t, tolerance));
      });
  if (best > 0.0 && box_a.overlaps(to_a(box_b)) && (contains(a, b_in_a, b) || contains(b, a_in_b, a))) return 0.0;
  return best;
}

double free_way(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, const Vec3& direction,
                double limit) {
  if (a.mesh().empty() || b.mesh().empty()) return limit;
  // Both in a frame with z against the direction, where a box's shadow is its x and y.
  const Quat upright = Quat::FromTwoVectors(-direction, Vec3::UnitZ());
  const auto stand = [&](const Pose& pose) { return Pose{upright * pose.position, upright * pose.orientation}; };
  const Pose stand_a = stand(pose_a), stand_b = stand(pose_b);
  const BoxMotion motion_a(stand_a), motion_b(stand_b);
  const Vec3 down = -Vec3::UnitZ();
  double best = limit;
  const auto bound = [&](const Aabb& one, const Aabb& other) {
    const bool beside = (one.lower - other.upper).cwiseMax(other.lower - one.upper).head<2>().maxCoeff() > 0.0;
    if (beside || one.upper.z() < other.lower.z()) return std::numeric_limits<double>::infinity();
    return std::max(0.0, one.lower.z() - other.upper.z());
  };
  walk(
      a, stand_a, b, stand_b, [&](const Aabb& one, const Aabb& other) { return bound(motion_a(one), motion_b(other)); },
      [&] { return best; },
      [&](const Facet& s, const Facet& t) {
        if (bound(s.box, t.box) < best) best = std::min(best, triangle_way(s.points, t.points, down));
      });
  return best;
}

}  // namespace bin_scenes
