/// Depths of contacts over the run: Solver::take_worst_contact().
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

/// A contact at the start of the step.
struct Found {
  Vec3f on_a, on_b;  ///< points on the surfaces (m, bin frame)
  float depth;       ///< m: along the normal
};

Found found(const Contact& c, const Body& a, const Body* b) {
  const Vec3f on_a = a.x + a.rotation * c.anchor_a, on_b = b ? Vec3f(b->x + b->rotation * c.anchor_b) : c.anchor_b;
  const bool field_of_a = c.feature >> 31;
  const Vec3f normal = field_of_a ? Vec3f(a.rotation * c.local_normal)
                       : b        ? Vec3f(b->rotation * c.local_normal)
                                  : c.local_normal;
  return {on_a, on_b, (on_a - on_b).dot(normal)};
}

/// Returns the largest depth (m) of the contacts of a manifold. Depths up to `limit` (m) need not be exact.
float depth_of(const World& world, const Manifold& m, float limit) {
  const Body& a = world.bodies[m.a];
  const Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
  float deepest = 0;
  for (const Contact& contact : m.contacts) {
    const Found c = found(contact, a, b);
    float depth = c.depth;
    if (b && depth > limit)
      depth = overlap_at(Placed{world.shapes[a.shape]->field, a.rotation, a.x},
                         Placed{world.shapes[b->shape]->field, b->rotation, b->x}, c.on_a, c.on_b, depth);
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
