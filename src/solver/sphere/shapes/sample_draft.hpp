/// A draft of the samples of a part: nodes and pieces of edges in model axes, before they are sorted into clusters.
/// contact_samples.hpp completes it with samples of faces.
#pragma once

#include "solver/sphere/shapes/contact_samples.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

struct Draft {
  std::vector<Vec3> nodes;  ///< m, model frame
  std::vector<Cone> cones;  ///< normal cones of the nodes
  std::vector<Edge> edges;
  std::vector<std::uint32_t> at_vertex;  ///< by vertex of the mesh: index of the node at the vertex, or `none`

  static constexpr std::uint32_t none = 0xffffffffu;

  /// Adds a node and returns its index.
  std::uint32_t add(const Vec3& node, const Cone& cone);
  /// Adds the edge between two vertices that have nodes, in pieces no longer than `spacing` (m).
  void add_edge(const Mesh& mesh, std::uint32_t from, std::uint32_t to, const Cone& cone, bool sharp, double spacing);
};

/// Returns a draft of the sharp edges, cut into pieces no longer than `spacing` (m). Each corner is one node.
Draft edge_draft(const Mesh& mesh, const SharpEdges& sharp, double spacing);

}  // namespace bin_scenes::sphere
