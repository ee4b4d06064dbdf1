/// Depths of contacts over the run: Solver::take_worst_contact().
#include "solver/sphere/passes/contact_gap.hpp"
#include "solver/sphere/shared_code.hpp"
#include "solver/sphere/world.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

namespace {

struct Placed {
  const Field& field;
  const Mat3f& rotation;
  const Vec3f& position;
};

#include "shared/sphere/overlap.h"

/// Returns the largest depth (m) of the contacts of a manifold. Depths up to `limit` (m) need not be exact.
float depth_of(const World& world, const Manifold& m, float limit) {
  const Body& a = world.bodies[m.a];
  const Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
  float deepest = 0;
  for (const Contact& contact : m.contacts) {
    float depth = -separation(contact, a, b);
    if (b && depth > limit)
      depth = overlap_at(Placed{world.shapes[a.shape]->field, a.rotation, a.x},
                         Placed{world.shapes[b->shape]->field, b->rotation, b->x}, on_a(contact, a), on_b(contact, b),
                         depth);
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

}  // namespace

void note_depths(World& world) {
  DeepestContact& deepest = world.deepest;
  for (const std::uint32_t i : world.order) {
    const Manifold& m = world.manifolds[i];
    float diagonal = world.shapes[world.bodies[m.a].shape]->diagonal;
    if (m.b != ground) diagonal = std::min(diagonal, world.shapes[world.bodies[m.b].shape]->diagonal);
    BIN_SCENES_ASSERT(diagonal > 0);
    const float depth = depth_of(world, m, deepest.relative * diagonal), relative = depth / diagonal;
    if (relative <= deepest.relative) continue;
    deepest.a = m.a;
    deepest.b = m.b;
    deepest.depth = depth;
    deepest.relative = relative;
    deepest.time = world.clock;
  }
}

}  // namespace bin_scenes::sphere
