/// A draft of the samples of a part: nodes and pieces of edges in model axes, before they are sorted into clusters.
/// contact_samples.hpp completes it with samples of faces.
#pragma once

#include "solver/sphere/shapes/contact_samples.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

struct Draft {
  std::vector<Vec3> nodes;  ///< m
  std::vector<Cone> cones;  ///< normal cones of the nodes
  std::vector<Edge> edges;
  std::vector<std::uint32_t> at_vertex;  ///< by vertex of the mesh: the node at the vertex, or `none`

  static constexpr std::uint32_t none = 0xffffffffu;

  /// Number of the new node.
  std::uint32_t add(const Vec3& node, const Cone& cone);
  /// Between two vertices that have nodes, in pieces no longer than `spacing` (m).
  void add_edge(const Mesh& mesh, std::uint32_t from, std::uint32_t to, const Cone& cone, bool sharp, double spacing);
};

/// Sharp edges cut in pieces no longer than `spacing` (m); corners appear once.
Draft edge_draft(const Mesh& mesh, const SharpEdges& sharp, double spacing);

}  // namespace bin_scenes::sphere
