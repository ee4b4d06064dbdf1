/// The separating axes are the normals of the zonotope's faces and of the triangle, and the products of their edges.
/// Boxes of the tree are tested with the axes of faces and coordinates only: this may visit a node that is apart, but
/// never skips one that is not.
#include "grasp/sweep.hpp"

#include "part/tree_walk.hpp"

#include <cmath>

namespace bin_scenes {

Sweep::Sweep(const Pose& pose, const Vec3& center, const Vec3& half) : center_(pose * center) {
  for (int i = 0; i < 3; ++i) add(pose.orientation * (half[i] * Vec3::Unit(i)));
  finish();
}

Sweep Sweep::cylinder(const Pose& pose, double radius, double low, double high) {
  Sweep sweep;
  sweep.center_ = pose * Vec3(0.0, 0.0, 0.5 * (low + high));
  // Four segments, 45 degrees apart, add up to an octagon whose sides touch the circle.
  const double half = radius * std::tan(M_PI / 8.0);
  for (int i = 0; i < 4; ++i) {
    const double angle = M_PI / 4.0 * i;
    sweep.add(pose.orientation * Vec3(half * std::cos(angle), half * std::sin(angle), 0.0));
  }
  sweep.add(pose.orientation * Vec3(0.0, 0.0, 0.5 * (high - low)));
  sweep.finish();
  return sweep;
}

Sweep Sweep::moved(const Vec3& displacement) const {
  Sweep sweep = *this;
  sweep.center_ += 0.5 * displacement;
  sweep.add(0.5 * displacement);
  sweep.finish();
  return sweep;
}

Sweep Sweep::placed(const Pose& pose) const {
  Sweep sweep = *this;
  sweep.center_ = pose * center_;
  for (int i = 0; i < count_; ++i) sweep.halves_[i] = pose.orientation * halves_[i];
  sweep.finish();
  return sweep;
}

void Sweep::add(const Vec3& half) {
  halves_[static_cast<std::size_t>(count_++)] = half;
}

double Sweep::extent(const Vec3& axis) const {
  double sum = 0.0;
  for (int i = 0; i < count_; ++i) sum += std::abs(axis.dot(halves_[i]));
  return sum;
}

double Sweep::lowest(const Vec3& direction) const {
  return direction.dot(center_) - extent(direction);
}

void Sweep::finish() {
  Vec3 reach = Vec3::Zero();
  for (int i = 0; i < count_; ++i) reach += halves_[i].cwiseAbs();
  bounds_.lower = center_ - reach;
  bounds_.upper = center_ + reach;
  face_count_ = 0;
  for (int i = 0; i < count_; ++i) {
    for (int j = i + 1; j < count_; ++j) {
      Vec3 normal = halves_[i].cross(halves_[j]);
      const double length = normal.norm();
      if (length <= 1e-9 * halves_[i].norm() * halves_[j].norm()) continue;  // along each other
      normal /= length;
      faces_[static_cast<std::size_t>(face_count_++)] = {normal, extent(normal)};
    }
  }
}

bool Sweep::apart_on(const Vec3& axis, const Vec3& a, const Vec3& b, const Vec3& c) const {
  const double x = axis.dot(a), y = axis.dot(b), z = axis.dot(c), reach = extent(axis);
  return std::min(x, std::min(y, z)) >= reach || std::max(x, std::max(y, z)) <= -reach;
}

bool Sweep::meets(const Vec3& p, const Vec3& q, const Vec3& r) const {
  const Vec3 a = p - center_, b = q - center_, c = r - center_;
  for (int f = 0; f < face_count_; ++f) {
    const auto& [normal, reach] = faces_[f];
    const double x = normal.dot(a), y = normal.dot(b), z = normal.dot(c);
    if (std::min(x, std::min(y, z)) >= reach || std::max(x, std::max(y, z)) <= -reach) return false;
  }
  const std::array<Vec3, 3> edges = {b - a, c - b, a - c};
  if (apart_on(edges[0].cross(edges[1]), a, b, c)) return false;
  for (const Vec3& edge : edges) {
    for (int i = 0; i < count_; ++i) {
      const Vec3 axis = edge.cross(halves_[i]);
      if (axis.squaredNorm() <= 1e-18 * edge.squaredNorm() * halves_[i].squaredNorm()) continue;
      if (apart_on(axis, a, b, c)) return false;
    }
  }
  return true;
}

bool Sweep::meets(const MeshQuery& mesh, const Pose& pose) const {
  const Sweep here = placed(pose.inverse());
  const auto apart = [&](const Aabb& box) {
    if (!here.bounds_.overlaps(box)) return true;
    const Vec3 mid = box.center() - here.center_, half = 0.5 * box.size();
    for (int f = 0; f < here.face_count_; ++f) {
      const Face& face = here.faces_[f];
      if (std::abs(face.normal.dot(mid)) > face.extent + face.normal.cwiseAbs().dot(half)) return true;
    }
    return false;
  };
  const auto& v = mesh.mesh().vertices;
  return any_near(mesh, apart, [&](std::size_t triangle) {
    const Triangle& t = mesh.mesh().triangles[triangle];
    return here.meets(v[t[0]], v[t[1]], v[t[2]]);
  });
}

}  // namespace bin_scenes
