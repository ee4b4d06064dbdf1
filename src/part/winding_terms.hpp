/// The terms that add up to a winding number: solid angles of near triangles, and an expansion for groups of far
/// triangles (fast winding numbers, Barill et al. 2018).
#pragma once

#include "bin_scenes/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// A corner and two edges of a triangle, for point-triangle distances and solid angles; stored in tree order.
struct Corner {
  Vec3 a, ab, ac;
  std::uint32_t triangle;
};

/// The far field of the triangles of a node: the first three terms of the expansion of the winding number about
/// `center` (Barill et al. 2018, "Fast winding numbers for soups and clouds", section 3). With n dA the area element at
/// center + x and M_jk the integral of x_j x_k over a triangle, these contractions suffice:
struct Moments {
  Vec3 center = Vec3::Zero();      // area-weighted centroid
  double reach = 0.0;              // distance from the centre to the farthest corner
  Vec3 area = Vec3::Zero();        // integral of n
  Mat3 first = Mat3::Zero();       // integral of n x^T
  Vec3 traces = Vec3::Zero();      // integral of 2 (n . x) x + |x|^2 n
  std::array<double, 10> cubic{};  // integral of (n . r)(x . r)^2 as a polynomial in r, see cubic_form
};

/// The expansion replaces the triangles of a node for points at least this many times `reach` away. Its error is at
/// most 3e-3 (3e-4 r.m.s.), far too small to change the result of "> 0.5".
constexpr double far_ratio = 3.0;

inline double cubic_form(const std::array<double, 10>& c, const Vec3& r) {
  const double x = r.x(), y = r.y(), z = r.z();
  return x * (x * (c[0] * x + c[3] * y + c[4] * z) + y * (c[5] * y + c[9] * z)) + y * y * (c[1] * y + c[6] * z) +
         z * z * (c[7] * x + c[8] * y + c[2] * z);
}

inline void add_cubic(std::array<double, 10>& c, const Vec3& n, const Mat3& m) {
  c[0] += n.x() * m(0, 0);
  c[1] += n.y() * m(1, 1);
  c[2] += n.z() * m(2, 2);
  c[3] += 2.0 * n.x() * m(0, 1) + n.y() * m(0, 0);
  c[4] += 2.0 * n.x() * m(0, 2) + n.z() * m(0, 0);
  c[5] += 2.0 * n.y() * m(0, 1) + n.x() * m(1, 1);
  c[6] += 2.0 * n.y() * m(1, 2) + n.z() * m(1, 1);
  c[7] += 2.0 * n.z() * m(0, 2) + n.x() * m(2, 2);
  c[8] += 2.0 * n.z() * m(1, 2) + n.y() * m(2, 2);
  c[9] += 2.0 * (n.x() * m(1, 2) + n.y() * m(0, 2) + n.z() * m(0, 1));
}

/// Returns the moments of the triangles corners[begin, end).
inline Moments moments_of(const std::vector<Corner>& corners, std::size_t begin, std::size_t end) {
  Moments m;
  double total = 0.0;
  Vec3 plain = Vec3::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    const Corner& t = corners[i];
    const Vec3 area = 0.5 * t.ab.cross(t.ac), centroid = t.a + (t.ab + t.ac) / 3.0;
    total += area.norm();
    m.center += area.norm() * centroid;
    m.area += area;
    plain += centroid;
  }
  m.center = total > 0.0 ? Vec3(m.center / total) : Vec3(plain / static_cast<double>(end - begin));
  for (std::size_t i = begin; i < end; ++i) {
    const Corner& t = corners[i];
    const Vec3 a = t.a - m.center, b = a + t.ab, c = a + t.ac, sum = a + b + c;
    const Vec3 area = 0.5 * t.ab.cross(t.ac);
    const Mat3 second = (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose()) / 12.0;
    m.first += area * sum.transpose() / 3.0;
    m.traces += 2.0 * (second * area) + second.trace() * area;
    add_cubic(m.cubic, area, second);
    m.reach = std::max({m.reach, a.norm(), b.norm(), c.norm()});
  }
  return m;
}

/// Adds up solid angles of triangles seen from a point, as the angle of a product of complex numbers: one arc tangent
/// for all instead of one each.
class SolidAngles {
 public:
  /// Adds a triangle, seen from p (van Oosterom & Strackee 1983, "The solid angle of a plane triangle").
  void add(const Corner& t, const Vec3& p) {
    const Vec3 a = t.a - p, b = a + t.ab, c = a + t.ac;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    turn(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb, a.dot(b.cross(c)));
  }
  double sum() const { return 2.0 * (std::atan2(y_ + 0.0, x_) + turns_ * 2.0 * M_PI); }

 private:
  void turn(double x, double y) {
    const double length = std::sqrt(x * x + y * y);
    if (!(length > 0.0)) return;  // at a corner: no angle
    const double before = y_;
    const double next = (x_ * x - y_ * y) / length;
    y_ = (x_ * y + y_ * x) / length;
    x_ = next;
    if (before >= 0.0 && y >= 0.0 && y_ < 0.0) ++turns_;
    if (before < 0.0 && y < 0.0 && y_ >= 0.0) --turns_;
  }

  double x_ = 1.0, y_ = 0.0;
  int turns_ = 0;
};

/// Returns 4 pi times the winding number of a far node's triangles about p.
inline double far_solid_angle(const Moments& m, const Vec3& p) {
  const Vec3 r = m.center - p;
  const double inverse2 = 1.0 / r.squaredNorm(), inverse3 = inverse2 * std::sqrt(inverse2);
  const double dipole = m.area.dot(r);
  const double gradient = m.first.trace() - 3.0 * inverse2 * r.dot(m.first * r);
  const double curvature = inverse2 * (-1.5 * m.traces.dot(r) + 7.5 * inverse2 * cubic_form(m.cubic, r));
  return inverse3 * (dipole + gradient + curvature);
}

}  // namespace bin_scenes
