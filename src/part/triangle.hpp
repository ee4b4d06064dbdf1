/// Finds the point of a triangle that is nearest to a given point. It is the innermost loop of distance fields and
/// voxelisation.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <algorithm>

namespace bin_scenes {

/// A triangle prepared for many nearest-point queries.
/// Ericson 2005, "Real-Time Collision Detection", section 5.1.5, with the constant products computed in advance.
struct PreparedTriangle {
  Vec3 a, ab, ac, normal;
  double ab_ab, ab_ac, ac_ac;

  PreparedTriangle(const Vec3& a_, const Vec3& b, const Vec3& c)
      : a(a_), ab(b - a_), ac(c - a_), ab_ab(ab.dot(ab)), ab_ac(ab.dot(ac)), ac_ac(ac.dot(ac)) {
    normal = ab.cross(ac);
    const double length = normal.norm();
    // A sliver has no reliable normal; zero marks this.
    normal = length > 1e-9 * longest_squared() ? Vec3(normal / length) : Vec3::Zero();
  }

  Vec3 nearest(const Vec3& p) const {
    const Vec3 ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = d1 - ab_ab, d4 = d2 - ab_ac;
    if (d3 >= 0 && d4 <= d3) return a + ab;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * ratio(d1, d1 - d3);
    const double d5 = d1 - ab_ac, d6 = d2 - ac_ac;
    if (d6 >= 0 && d5 <= d6) return a + ac;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * ratio(d2, d2 - d6);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return a + ab + (ac - ab) * ratio(d4 - d3, d4 - d3 + d5 - d6);
    const double scale = 1.0 / (va + vb + vc);
    return a + ab * (vb * scale) + ac * (vc * scale);
  }

 private:
  double longest_squared() const { return std::max({ab_ab, ac_ac, ab_ab - 2 * ab_ac + ac_ac}); }
  /// Returns part / whole; 0 for an edge of a degenerate triangle without length.
  static double ratio(double part, double whole) { return whole > 0 ? part / whole : 0.0; }
};

}  // namespace bin_scenes
