/// What a moving box sweeps, and whether a placed mesh meets it.
///
/// A box moved along a line sweeps a zonotope: the sum of segments, three for the box and one for the line. So does a
/// round cup, as an eight-sided prism. One separating-axis test serves all of them, and is exact for triangles.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <array>

namespace bin_scenes {

class Sweep {
 public:
  /// @param half  half sides of the box in its own frame
  Sweep(const Pose& pose, const Vec3& center, const Vec3& half);
  /// An eight-sided prism around a cylinder about the frame's z, from z = low to high.
  static Sweep cylinder(const Pose& pose, double radius, double low, double high);
  /// The same body moved by `displacement` as well.
  Sweep moved(const Vec3& displacement) const;
  /// The same body with the pose in front.
  Sweep placed(const Pose& pose) const;

  const Aabb& bounds() const { return bounds_; }
  double lowest(const Vec3& direction) const;
  /// Whether any triangle of the mesh, placed by `pose`, has a point inside; touching is none.
  bool meets(const MeshQuery& mesh, const Pose& pose) const;
  bool meets(const Vec3& a, const Vec3& b, const Vec3& c) const;

 private:
  static constexpr int most = 6;  // segments: an octagon's four, a prism's one, a displacement's one
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
