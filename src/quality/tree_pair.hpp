/// Walks over the triangle trees of two placed meshes at once. All results are in the frame of the first mesh.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <array>
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

/// A triangle of a placed mesh, with what is asked of it again and again.
struct Facet {
  Facet() = default;
  explicit Facet(const TrianglePoints& points, std::size_t triangle = 0)
      : points(points),
        normal((points[1] - points[0]).cross(points[2] - points[0]).normalized()),
        box(bounds(points)),
        triangle(triangle) {}

  TrianglePoints points;
  Vec3 normal;  ///< unit; 0 of one without area
  Aabb box;
  std::size_t triangle = 0;  ///< of the mesh
};

/// A rigid motion ready to bound moved boxes: the box of a turned box (Ericson 2005, section 4.2.6).
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

/// Depth-first walk over pairs of nodes. `bound(a box, b box)` (each in its own mesh's frame) is a number that no
/// pair of triangles below can undercut; a pair is entered while it is < limit(). Of two children the one with the
/// smaller bound comes first. `leaf` gets pairs of triangles, moved by the poses.
template <class Bound, class Limit, class Leaf>
void walk(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b, Bound&& bound, Limit&& limit,
          Leaf&& leaf) {
  const std::vector<MeshQuery::Node>&na = a.nodes(), &nb = b.nodes();
  if (na.empty() || nb.empty()) return;
  std::array<Facet, MeshQuery::leaf_size> facets_a, facets_b;
  const auto place = [](const MeshQuery& query, const Pose& pose, const MeshQuery::Node& node, auto& facets) {
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const std::size_t triangle = query.leaf_triangle(node.first + k);
      facets[k] = Facet(moved(pose, points_of(query.mesh(), triangle)), triangle);
    }
  };
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
      place(a, pose_a, one, facets_a);
      place(b, pose_b, other, facets_b);
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

/// Largest gap between two boxes along an axis of the first one's frame; negative if none separates them.
inline double axis_gap(const Aabb& a, const Aabb& b) {
  return (a.lower - b.upper).cwiseMax(b.lower - a.upper).maxCoeff();
}

/// Shortest distance of two boxes.
inline double box_distance(const Aabb& a, const Aabb& b) {
  return (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0).norm();
}

}  // namespace bin_scenes
