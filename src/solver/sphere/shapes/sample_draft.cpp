#include "solver/sphere/shapes/sample_draft.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bin_scenes::sphere {

std::uint32_t Draft::add(const Vec3& node, const Cone& cone) {
  nodes.push_back(node);
  cones.push_back(cone);
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

void Draft::add_edge(const Mesh& mesh, std::uint32_t from, std::uint32_t to, const Cone& cone, bool sharp,
                     double spacing) {
  const Vec3 a = mesh.vertices[from], b = mesh.vertices[to];
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
  BIN_SCENES_ASSERT(spacing > 0 && at_vertex[from] != none && at_vertex[to] != none);
  std::uint32_t last = at_vertex[from];
  for (int i = 1; i <= pieces; ++i) {
    const std::uint32_t next = i == pieces ? at_vertex[to] : add(a + (b - a) * (static_cast<double>(i) / pieces), cone);
    edges.push_back({last, next, 0, sharp, cone});
    last = next;
  }
}

namespace {

/// Cone of a vertex of many edges: that about the mean direction of its faces that holds the normals of all of them.
/// All directions beside a sliver.
Cone round_cone(const Mesh& mesh, std::uint32_t vertex, const std::vector<const SharpEdge*>& edges) {
  std::vector<Vec3> normals;
  Vec3 sum = Vec3::Zero();
  for (const SharpEdge* edge : edges) {
    if (edge->cone.bounds == 0) return Cone{};
    const std::uint32_t other = edge->a == vertex ? edge->b : edge->a;
    const Vec3 along = (mesh.vertices[other] - mesh.vertices[vertex]).normalized();
    for (int side = 0; side < 2; ++side) {
      const Vec3 across = along.cross(edge->cone.bound[side].cast<double>());
      const Vec3 away = -edge->cone.bound[1 - side].cast<double>();
      sum += normals.emplace_back(across.dot(away) < 0 ? -across : across);
    }
  }
  Cone cone;
  cone.axis = sum.normalized().cast<float>();
  double least = 1;
  for (const Vec3& normal : normals) least = std::min(least, normal.dot(cone.axis.cast<double>()));
  cone.spread = static_cast<float>(std::acos(std::max(0.0, least)));
  return cone;
}

/// Cone of a vertex from the sharp edges that end there: three or more bound it themselves, two with their faces.
Cone corner_cone(const Mesh& mesh, std::uint32_t vertex, const std::vector<const SharpEdge*>& edges) {
  Cone cone;
  const auto add = [&](const Vec3f& bound) {
    if (cone.bounds < Cone::max_bounds) cone.bound[cone.bounds++] = bound;
  };
  if (edges.size() < 2) return cone;
  if (edges.size() > static_cast<std::size_t>(Cone::max_bounds)) return round_cone(mesh, vertex, edges);
  for (const SharpEdge* edge : edges) {
    if (edge->cone.bounds == 0) return Cone{};
    const std::uint32_t other = edge->a == vertex ? edge->b : edge->a;
    add((mesh.vertices[other] - mesh.vertices[vertex]).normalized().cast<float>());
  }
  if (edges.size() == 2)
    for (const SharpEdge* edge : edges)
      for (int i = 0; i < 2; ++i) add(edge->cone.bound[i]);
  return cone;
}

/// Cone of a vertex where a concave edge ends, too: away from all faces of its sharp edges.
Cone saddle_cone(const std::vector<const SharpEdge*>& edges) {
  Cone cone;
  if (2 * edges.size() > static_cast<std::size_t>(Cone::max_bounds)) return cone;
  for (const SharpEdge* edge : edges) {
    if (edge->cone.bounds == 0) return Cone{};
    for (int i = 0; i < 2; ++i) cone.bound[cone.bounds++] = edge->cone.bound[i];
  }
  return cone;
}

}  // namespace

Draft edge_draft(const Mesh& mesh, const SharpEdges& sharp, double spacing) {
  Draft draft;
  draft.nodes.reserve(2 * sharp.convex.size());
  draft.cones.reserve(2 * sharp.convex.size());
  draft.edges.reserve(2 * sharp.convex.size());
  // The edges at each vertex, one vertex after the other.
  std::vector<std::size_t> last(mesh.vertices.size() + 1, 0);
  for (const SharpEdge& edge : sharp.convex)
    for (const std::uint32_t v : {edge.a, edge.b}) ++last[v + 1];
  std::partial_sum(last.begin(), last.end(), last.begin());
  std::vector<const SharpEdge*> around(last.back());
  for (const SharpEdge& edge : sharp.convex)
    for (const std::uint32_t v : {edge.a, edge.b}) around[last[v]++] = &edge;
  draft.at_vertex.assign(mesh.vertices.size(), Draft::none);
  std::vector<const SharpEdge*> edges;
  std::size_t first = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); first = last[v++]) {
    if (first == last[v]) continue;
    edges.assign(around.begin() + first, around.begin() + last[v]);
    draft.at_vertex[v] =
        draft.add(mesh.vertices[v], sharp.saddles[v] ? saddle_cone(edges) : corner_cone(mesh, v, edges));
  }
  for (const SharpEdge& edge : sharp.convex)
    draft.add_edge(mesh, edge.a, edge.b, edge.cone, edge.cone.bounds > 0, spacing);
  return draft;
}

}  // namespace bin_scenes::sphere
