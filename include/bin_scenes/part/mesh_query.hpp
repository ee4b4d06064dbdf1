/// Exact queries on a triangle mesh: the nearest point, and whether a point is inside. The quality of scenes and the
/// errors of collision shapes are measured with them. They are slower than a look-up in a distance field
/// (distance_field.hpp), which the solver uses instead.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <memory>

namespace bin_scenes {

/// The nearest point of a surface.
struct NearestPoint {
  Vec3 point = Vec3::Zero();  ///< a point of the surface, model frame (m)
  double distance = 0.0;      ///< unsigned distance to this point (m)
  /// Index of the triangle that contains the point.
  std::size_t triangle = 0;
};

/// A bounding-volume tree over the triangles of a mesh. It is immutable after construction and may be shared between
/// threads.
class MeshQuery {
 public:
  explicit MeshQuery(Mesh mesh);
  ~MeshQuery();
  MeshQuery(MeshQuery&&) noexcept;
  MeshQuery& operator=(MeshQuery&&) noexcept;

  const Mesh& mesh() const;
  /// Returns the nearest point of the surface; its distance is infinite if nothing is closer than `limit` (m). A small
  /// limit makes the search faster. The distance that was found for a neighbouring point plus the distance between the
  /// two points is always a valid limit.
  NearestPoint nearest(const Vec3& point, double limit = std::numeric_limits<double>::infinity()) const;
  /// Returns the generalised winding number: 1 inside, 0 outside; it is robust to small gaps and to shells that overlap
  /// (above 0.5 means inside). Far triangles are summed by a tree expansion (Barill et al. 2018) with an error below
  /// 3e-3, 3e-4 r.m.s.
  double winding(const Vec3& point) const;
  /// Whether the winding number is above 0.5. The test is exact and fast for a closed mesh.
  bool inside(const Vec3& point) const;
  /// Returns the signed distance to the surface (m), negative inside.
  double signed_distance(const Vec3& point) const;
  /// Calls visit(triangle index) for each triangle whose bounds overlap the box (model frame).
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    overlapping_impl(
        box, [](void* v, std::size_t t) { (*static_cast<std::remove_reference_t<Visit>*>(v))(t); }, &visit);
  }

  static constexpr std::size_t leaf_size = 4;  ///< largest number of triangles in a leaf

  /// A node of the tree. Nodes are in depth-first order: the first child of an inner node follows it, and `first` is
  /// the index of its second child. A leaf (count > 0) contains the triangles leaf_triangle(first) to
  /// leaf_triangle(first + count - 1).
  struct Node {
    Aabb box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  /// Returns the nodes of the tree, for traversals of two meshes at once; empty for an empty mesh.
  const std::vector<Node>& nodes() const;
  /// Returns the index of the triangle at a position of a leaf.
  std::size_t leaf_triangle(std::size_t position) const;
  /// The box of a node in single precision, enlarged by rounding: centre and half the size in four lanes, of which the
  /// last is 0.
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
