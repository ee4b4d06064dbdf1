/// Depths of contacts over the run: Solver::take_worst_contact().
#include "solver/sphere/world.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

void note_depths(World& world) {
  DeepestContact& deepest = world.deepest;
  for (const std::uint32_t i : world.order) {
    const Manifold& m = world.manifolds[i];
    if (m.depth <= 0) continue;
    float diagonal = world.shapes[world.bodies[m.a].shape]->diagonal;
    if (m.b != ground) diagonal = std::min(diagonal, world.shapes[world.bodies[m.b].shape]->diagonal);
    BIN_SCENES_ASSERT(diagonal > 0);
    const float relative = m.depth / diagonal;
    if (relative <= deepest.relative) continue;
    deepest.a = m.a;
    deepest.b = m.b;
    deepest.depth = m.depth;
    deepest.relative = relative;
    deepest.time = world.clock;
  }
}

}  // namespace bin_scenes::sphere
