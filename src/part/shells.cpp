#include "shells.hpp"

#include "core/disjoint_sets.hpp"

namespace bin_scenes {

Shells shells_of(const Mesh& mesh) {
  DisjointSets vertices(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    vertices.join(a, b);
    vertices.join(a, c);
  }
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.vertices.size(), none);  // of the shell of each root
  Shells result;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& shell = number[vertices.root(t[0])];
    if (shell == none) shell = static_cast<std::uint32_t>(result.count++);
    result.of_triangle.push_back(shell);
  }
  return result;
}

}  // namespace bin_scenes
