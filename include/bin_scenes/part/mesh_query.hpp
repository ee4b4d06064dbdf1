/// Exact queries on a triangle mesh: nearest point, inside or outside. Quality and shape errors are measured with them.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <memory>

namespace bin_scenes {

struct NearestPoint {
  Vec3 point = Vec3::Zero();  ///< on the surface
  double distance = 0.0;      ///< unsigned (m)
  std::size_t triangle = 0;
};

/// Bounding-volume tree over the triangles of a mesh; immutable after construction, safe to share between threads.
class MeshQuery {
 public:
  explicit MeshQuery(Mesh mesh);
  ~MeshQuery();
  MeshQuery(MeshQuery&&) noexcept;
  MeshQuery& operator=(MeshQuery&&) noexcept;

  const Mesh& mesh() const;
  /// Nearest surface point; returns distance = infinity beyond `limit`. A small limit is faster; the distance found
  /// for a neighbouring point plus the distance between the points is always a valid one.
  NearestPoint nearest(const Vec3& point, double limit = std::numeric_limits<double>::infinity()) const;
  /// Generalised winding number: 1 inside, 0 outside, robust to small gaps and overlapping shells (> 0.5 = inside).
  /// Far triangles are summed by a tree expansion (Barill et al. 2018): error below 3e-3, 3e-4 r.m.s.
  double winding(const Vec3& point) const;
  /// Whether the winding number is above 0.5; exact and fast for a closed mesh.
  bool inside(const Vec3& point) const;
  /// Negative inside (m).
  double signed_distance(const Vec3& point) const;
  /// Calls visit(triangle index) for triangles whose bounds overlap the box (model frame).
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    overlapping_impl(
        box, [](void* v, std::size_t t) { (*static_cast<std::remove_reference_t<Visit>*>(v))(t); }, &visit);
  }

  static constexpr std::size_t leaf_size = 4;  ///< triangles in a leaf, at most

  /// Node of the tree. Depth-first order: an inner node's first child follows it, `first` is its second child. A leaf
  /// (count > 0) holds the triangles leaf_triangle(first) .. leaf_triangle(first + count - 1).
  struct Node {
    Aabb box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  /// The nodes of the tree, for traversals of two meshes at once; empty for an empty mesh.
  const std::vector<Node>& nodes() const;
  std::size_t leaf_triangle(std::size_t position) const;
  /// The box of a node in single precision, a little larger: four lanes, of which the last is 0.
  struct NodeBox {
    Eigen::Array4f center, half;
  };
  const std::vector<NodeBox>& boxes() const;  ///< by node

 private:
  void overlapping_impl(const Aabb& box, void (*visit)(void*, std::size_t), void* context) const;
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace bin_scenes
