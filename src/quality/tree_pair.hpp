/// Traversals of the triangle trees of two placed meshes at once, for overlaps and distances. All results are in the
/// frame of the first mesh.
#pragma once

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/mesh_query.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <array>
#include <optional>
#include <vector>

namespace bin_scenes {

using TrianglePoints = std::array<Vec3, 3>;

inline TrianglePoints points_of(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

inline TrianglePoints moved(const Pose& pose, const TrianglePoints& t) {
  return {pose * t[0], pose * t[1], pose * t[2]};
}

inline Aabb bounds(const TrianglePoints& t) {
  return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])};
}

/// A triangle of a placed mesh, with its bounding box and normal, which are used again and again.
struct Facet {
  Facet() = default;
  explicit Facet(const TrianglePoints& points, std::size_t triangle = 0)
      : points(points), box(bounds(points)), triangle(triangle) {}

  /// Returns the unit normal; 0 for a triangle without area. Computed on first use: most facets intersect nothing.
  const Vec3& normal() const {
    if (!normal_) normal_ = (points[1] - points[0]).cross(points[2] - points[0]).normalized();
    return *normal_;
  }

  TrianglePoints points;
  Aabb box;
  std::size_t triangle = 0;  ///< index of the triangle in the mesh

 private:
  mutable std::optional<Vec3> normal_;
};

/// The triangles of a leaf, transformed by a pose. They are kept while the same leaf is used.
class PlacedLeaf {
 public:
  PlacedLeaf(const MeshQuery& query, const Pose& pose) : query_(query), pose_(pose) {}

  /// Returns the triangles of a leaf; the first node(leaf).count of them are valid.
  const std::array<Facet, MeshQuery::leaf_size>& of(std::uint32_t leaf) {
    if (known_ && leaf == leaf_) return facets_;
    known_ = true;
    leaf_ = leaf;
    const MeshQuery::Node& node = query_.nodes()[leaf];
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const std::size_t triangle = query_.leaf_triangle(node.first + k);
      facets_[k] = Facet(moved(pose_, points_of(query_.mesh(), triangle)), triangle);
    }
    return facets_;
  }

 private:
  const MeshQuery& query_;
  Pose pose_;
  bool known_ = false;
  std::uint32_t leaf_ = 0;
  std::array<Facet, MeshQuery::leaf_size> facets_;
};

/// A rigid motion in the form that transforms bounding boxes: the box around a moved box (Ericson 2005, section 4.2.6).
class BoxMotion {
 public:
  explicit BoxMotion(const Pose& pose) : turn_(pose.orientation), size_(turn_.cwiseAbs()), shift_(pose.position) {}
  Aabb operator()(const Aabb& box) const {
    const Vec3 center = turn_ * box.center() + shift_, half = size_ * (0.5 * box.size());
    return {center - half, center + half};
  }

 private:
  Mat3 turn_, size_;
  Vec3 shift_;
};

/// Traverses pairs of nodes of two trees, depth first. `bound(box of a, box of b)`, each box in the frame of its own
/// mesh, returns a lower bound for all pairs of triangles of these nodes; a pair is entered if the bound is < limit().
/// Of two children, the one with the smaller bound is visited first. `leaf` is called with pairs of triangles, which
/// are transformed by the poses.
template <class Bound, class Limit, class Leaf>
void walk(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, Bound&& bound, Limit&& limit,
          Leaf&& leaf) {
  BIN_SCENES_ASSERT(is_rigid(pose_a) && is_rigid(pose_b));
  const std::vector<MeshQuery::Node>&na = a.nodes(), &nb = b.nodes();
  if (na.empty() || nb.empty()) return;
  PlacedLeaf leaf_a(a, pose_a), leaf_b(b, pose_b);
  struct Entry {
    std::uint32_t i, j;
    double bound;
  };
  std::vector<Entry> stack{{0, 0, bound(na[0].box, nb[0].box)}};
  while (!stack.empty()) {
    stop_if_cancelled();
    const Entry entry = stack.back();
    stack.pop_back();
    if (!(entry.bound < limit())) continue;
    const MeshQuery::Node &one = na[entry.i], &other = nb[entry.j];
    if (one.count && other.count) {
      const auto &facets_a = leaf_a.of(entry.i), &facets_b = leaf_b.of(entry.j);
      for (std::uint32_t i = 0; i < one.count; ++i) {
        for (std::uint32_t j = 0; j < other.count; ++j) leaf(facets_a[i], facets_b[j]);
      }
      continue;
    }
    // Open the larger of the two.
    const bool open_a = other.count || (!one.count && one.box.size().squaredNorm() > other.box.size().squaredNorm());
    Entry first = entry, second = entry;
    (open_a ? first.i : first.j) = (open_a ? entry.i : entry.j) + 1;
    (open_a ? second.i : second.j) = open_a ? one.first : other.first;
    first.bound = bound(na[first.i].box, nb[first.j].box);
    second.bound = bound(na[second.i].box, nb[second.j].box);
    if (second.bound < first.bound) std::swap(first, second);
    if (second.bound < limit()) stack.push_back(second);
    if (first.bound < limit()) stack.push_back(first);
  }
}

/// Rejects pairs of nodes of two placed trees whose boxes are certainly apart, by a separating-axis test in single
/// precision with the axes of both frames.
class NodePair {
 public:
  NodePair(const MeshQuery& a, const MeshQuery& b, const Pose& b_in_a, double tolerance)
      : a_(a.boxes()), b_(b.boxes()) {
    const Mat3 turn = b_in_a.orientation.toRotationMatrix();
    const auto lanes = [](const Vec3& v) {
      Eigen::Array4f out = Eigen::Array4f::Zero();
      out.head<3>() = v.cast<float>().array();
      return out;
    };
    for (int k = 0; k < 3; ++k) {
      turn_[k] = lanes(turn.col(k));
      back_[k] = lanes(turn.row(k));
      turn_size_[k] = turn_[k].abs() + rounding;
      back_size_[k] = back_[k].abs() + rounding;
    }
    shift_ = lanes(b_in_a.position);
    if (a_.empty() || b_.empty()) return;
    const double longest = b_in_a.position.norm() + reach(a.nodes()[0].box) + reach(b.nodes()[0].box);
    margin_ = static_cast<float>(tolerance + rounding * longest);
  }

  bool apart(std::uint32_t i, std::uint32_t j) const {
    const MeshQuery::NodeBox &a = a_[i], &b = b_[j];
    const Eigen::Array4f offset = sum(turn_, b.center) + shift_ - a.center;
    if ((offset.abs() - a.half - sum(turn_size_, b.half)).maxCoeff() > margin_) return true;
    return (sum(back_, offset).abs() - b.half - sum(back_size_, a.half)).maxCoeff() > margin_;
  }
  /// Whether node i of a is larger than node j of b.
  bool larger(std::uint32_t i, std::uint32_t j) const {
    return a_[i].half.matrix().squaredNorm() > b_[j].half.matrix().squaredNorm();
  }

 private:
  static constexpr float rounding = 2e-6f;  ///< relative rounding error of about ten operations on lengths
  static double reach(const Aabb& box) { return box.center().norm() + box.diagonal(); }
  static Eigen::Array4f sum(const std::array<Eigen::Array4f, 3>& columns, const Eigen::Array4f& v) {
    return columns[0] * v[0] + columns[1] * v[1] + columns[2] * v[2];
  }

  const std::vector<MeshQuery::NodeBox>&a_, &b_;
  std::array<Eigen::Array4f, 3> turn_, back_, turn_size_, back_size_;
  Eigen::Array4f shift_;
  float margin_ = 0.0f;
};

}  // namespace bin_scenes
