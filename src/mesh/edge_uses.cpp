#include "edge_uses.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cstdlib>

namespace bin_scenes::repair {

std::vector<EdgeUse> edge_uses(const Mesh& mesh) {
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(uses.begin(), uses.end());
  BIN_SCENES_ASSERT(each_is(uses, [](const EdgeUse& use) { return use.low <= use.high && use.corner < 3; }));
  return uses;
}

int surplus(const EdgeUse* first, const EdgeUse* last) {
  int forward = 0;
  for (const EdgeUse* use = first; use != last; ++use) forward += use->forward ? 1 : -1;
  return forward;
}

std::size_t open_edges(const Mesh& mesh) {
  std::size_t count = 0;
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    count += static_cast<std::size_t>(std::abs(surplus(first, last)));
  });
  return count;
}

}  // namespace bin_scenes::repair
