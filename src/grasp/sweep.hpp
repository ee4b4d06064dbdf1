/// The volume that a moving box or cup sweeps, and its collisions with placed meshes.
///
/// A box that moves along a line sweeps a zonotope: the sum of four segments, three of the box and one of the line. A
/// cup is an eight-sided prism, which is a zonotope as well. One separating-axis test serves all of them; it is exact
/// for triangles.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <array>

namespace bin_scenes {

class Sweep {
 public:
  /// @param half  half side lengths (m) of a box in the frame `pose`, whose centre is `center` in this frame
  Sweep(const Pose& pose, const Vec3& center, const Vec3& half);
  /// Returns an eight-sided prism around a cylinder about z of the frame `pose`, from z = low to high (m).
  static Sweep cylinder(const Pose& pose, double radius, double low, double high);
  /// Returns the volume that this body sweeps when it also moves along `displacement` (m).
  Sweep moved(const Vec3& displacement) const;
  /// Returns this body transformed by a pose.
  Sweep placed(const Pose& pose) const;

  const Aabb& bounds() const { return bounds_; }
  double lowest(const Vec3& direction) const;  ///< smallest coordinate along a unit direction (m)
  /// Returns whether a triangle of a mesh at `pose` reaches into the volume. Touching is no collision.
  bool meets(const MeshQuery& mesh, const Pose& pose) const;
  bool meets(const Vec3& a, const Vec3& b, const Vec3& c) const;

 private:
  static constexpr int most = 6;  // segments: 4 of an octagon, 1 of the height, 1 of a displacement
  Sweep() = default;
  void add(const Vec3& half);
  void finish();
  double extent(const Vec3& axis) const;
  bool apart_on(const Vec3& axis, const Vec3& a, const Vec3& b, const Vec3& c) const;

  Vec3 center_ = Vec3::Zero();
  std::array<Vec3, most> halves_;
  int count_ = 0;
  struct Face {
    Vec3 normal;
    double extent;
  };
  std::array<Face, most*(most - 1) / 2> faces_;
  int face_count_ = 0;
  Aabb bounds_;
};

}  // namespace bin_scenes
