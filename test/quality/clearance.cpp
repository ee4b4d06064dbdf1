#include "quality/clearance.hpp"

#include "quality/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes::test {

namespace {

constexpr double touching = 1e-9;  // relative to the smaller diagonal: lengths that rounding makes

/// Shortest distance of two boxes.
double box_distance(const Aabb& a, const Aabb& b) {
  return (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0).norm();
}

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
  if (facet.normal().isZero()) return best;
  for (const Vec3& x : s) {
    bool over = true;
    for (int i = 0; i < 3; ++i) over = over && facet.normal().cross(t[(i + 1) % 3] - t[i]).dot(x - t[i]) >= 0.0;
    if (!over) continue;
    const double height = facet.normal().dot(x - t[0]);
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

}  // namespace bin_scenes::test
