/// The search for a plane reflects its normal until the nearest points of both bodies along it are apart (Chung & Wang
/// 1996, "Quick collision detection of polytopes in virtual environments").
#include "grasp/separation.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <array>
#include <utility>

namespace bin_scenes {

namespace {

constexpr int most_reflections = 16;
constexpr double shrink = 1e-3;  ///< by which bodies are scaled towards their centres, so that touching ones are apart

double farthest(const Aabb& box, const Vec3& direction) {
  return direction.cwiseProduct(box.lower).cwiseMax(direction.cwiseProduct(box.upper)).sum();
}

}  // namespace

Vec3 farthest_vertex(const PlacedMesh& placed, const Vec3& direction) {
  const std::vector<MeshQuery::Node>& nodes = placed.mesh.nodes();
  const Mesh& mesh = placed.mesh.mesh();
  BIN_SCENES_ASSERT(!nodes.empty());
  const Vec3 along = placed.pose.orientation.conjugate() * direction;
  std::array<std::uint32_t, 128> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  double best = -std::numeric_limits<double>::infinity();
  Vec3 vertex = Vec3::Zero();
  while (size > 0) {
    const std::uint32_t at = stack[--size];
    const MeshQuery::Node& node = nodes[at];
    if (farthest(node.box, along) <= best) continue;
    if (node.count == 0) {
      const bool first = farthest(nodes[at + 1].box, along) > farthest(nodes[node.first].box, along);
      BIN_SCENES_ASSERT(size + 2 <= stack.size());
      stack[size++] = first ? node.first : at + 1;
      stack[size++] = first ? at + 1 : node.first;  // visited next
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      for (const std::uint32_t v : mesh.triangles[placed.mesh.leaf_triangle(i)])
        if (const double reach = along.dot(mesh.vertices[v]); reach > best) {
          best = reach;
          vertex = mesh.vertices[v];
        }
  }
  return placed.pose * vertex;
}

SeparatingPlane separating_plane(const PlacedMesh& moving, const Vec3& displacement, const PlacedMesh& other,
                                 double tolerance) {
  SeparatingPlane best;
  const auto extremes_along = [&](const Vec3& normal) {
    Vec3 near = farthest_vertex(moving, -normal);
    if (normal.dot(displacement) < 0.0) near += displacement;
    const Vec3 far = farthest_vertex(other, normal);
    const double gap = normal.dot(near - far);
    if (gap > best.gap) best = {normal, gap};
    return std::make_pair(near, far);
  };
  const Vec3 center = moving.pose * moving.mesh.nodes()[0].box.center();
  const Vec3 other_center = other.pose * other.mesh.nodes()[0].box.center();
  Vec3 normal = center - other_center;
  for (int i = 0; i < most_reflections && normal.norm() > 0.0; ++i) {
    normal.normalize();
    const auto [near, far] = extremes_along(normal);
    if (best.gap >= -tolerance) return best;
    const Vec3 apart = near + shrink * (center - near) - far - shrink * (other_center - far);
    normal -= 2.0 * normal.dot(apart) / apart.squaredNorm() * apart;
  }
  // Of bodies that overlap a little, reflections find no plane; it is often parallel to a face of one of them.
  for (const PlacedMesh* mesh : {&moving, &other})
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        normal = sign * (mesh->pose.orientation * Vec3::Unit(axis));
        if (normal.dot(displacement) >= 0.0) extremes_along(normal);
        if (best.gap >= -tolerance) return best;
      }
  return best;
}

}  // namespace bin_scenes
