/// The triangles of a mesh near something, by its tree.
#pragma once

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/mesh_query.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace bin_scenes {

/// `use(triangle)` for the triangles of all leaves whose boxes, and those above them, are not `apart(box)`, until it
/// returns true. Returns whether it did.
template <class Apart, class Use>
bool any_near(const MeshQuery& mesh, const Apart& apart, const Use& use) {
  const std::vector<MeshQuery::Node>& nodes = mesh.nodes();
  if (nodes.empty()) return false;
  std::array<std::uint32_t, 128> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t at = stack[--size];
    const MeshQuery::Node& node = nodes[at];
    if (apart(node.box)) continue;
    if (node.count == 0) {
      BIN_SCENES_ASSERT(size + 2 <= stack.size());
      stack[size++] = node.first;
      stack[size++] = at + 1;
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i)
      if (use(mesh.leaf_triangle(node.first + i))) return true;
  }
  return false;
}

}  // namespace bin_scenes
