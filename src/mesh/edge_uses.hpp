/// Lists the edges of a mesh with the triangles that use each of them. The repairs of meshes find open and shared edges
/// with this list.
#pragma once

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/mesh/mesh.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace bin_scenes::repair {

/// The use of an edge by one triangle. In a sorted list, all uses of an edge are adjacent.
struct EdgeUse {
  std::uint32_t low, high;  // indices of the vertices, ascending
  std::uint32_t triangle;
  std::uint8_t corner;  // the edge runs from this corner of the triangle to the next
  bool forward;         // whether it runs from low to high
  bool operator<(const EdgeUse& o) const {
    return std::tie(low, high, triangle, corner) < std::tie(o.low, o.high, o.triangle, o.corner);
  }
  bool same_edge(const EdgeUse& o) const { return low == o.low && high == o.high; }
};

std::vector<EdgeUse> edge_uses(const Mesh& mesh);

/// Calls visit(first, last) for the uses of each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit&& visit) {
  BIN_SCENES_ASSERT(std::is_sorted(uses.begin(), uses.end()));
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].same_edge(uses[i])) ++j;
    visit(uses.data() + i, uses.data() + j);
    i = j;
  }
}

/// Returns the number of uses from the lower to the higher vertex, minus those back. 0: the edge is closed.
int surplus(const EdgeUse* first, const EdgeUse* last);

/// Returns the number of open edges; an edge counts as often as its surplus. 0: the mesh is closed.
std::size_t open_edges(const Mesh& mesh);

}  // namespace bin_scenes::repair
