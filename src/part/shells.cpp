#include "shells.hpp"

#include <numeric>

namespace bin_scenes {

Shells shells_of(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.vertices.size(), none);  // of the shell of each root
  Shells result;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& shell = number[root(t[0])];
    if (shell == none) shell = static_cast<std::uint32_t>(result.count++);
    result.of_triangle.push_back(shell);
  }
  return result;
}

}  // namespace bin_scenes
