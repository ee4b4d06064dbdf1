/// The traversal of the bounding-volume tree of a mesh. All queries of mesh_query.hpp use this one function.
#pragma once

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/mesh_query.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace bin_scenes {

/// Calls `use(position)` for the triangles of all leaves that are not skipped, until it returns true. Returns whether
/// it did. A node for which `skip(index)` is true is skipped with all nodes below it.
template <class Skip, class Use>
bool any_leaf(const std::vector<MeshQuery::Node>& nodes, const Skip& skip, const Use& use) {
  if (nodes.empty()) return false;
  std::array<std::uint32_t, 128> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t at = stack[--size];
    if (skip(at)) continue;
    const MeshQuery::Node& node = nodes[at];
    if (node.count == 0) {
      BIN_SCENES_ASSERT(size + 2 <= stack.size());
      stack[size++] = node.first;
      stack[size++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (use(i)) return true;
  }
  return false;
}

/// Calls `use(triangle)` for the triangles of all leaves until it returns true, and returns whether it did. A node is
/// skipped with all nodes below it if `apart(box)` is true for its box.
template <class Apart, class Use>
bool any_near(const MeshQuery& mesh, const Apart& apart, const Use& use) {
  const std::vector<MeshQuery::Node>& nodes = mesh.nodes();
  return any_leaf(
      nodes, [&](std::uint32_t index) { return apart(nodes[index].box); },
      [&](std::uint32_t position) { return use(mesh.leaf_triangle(position)); });
}

}  // namespace bin_scenes
