// What the solve of a large world does with its manifolds, an invocation each: all of them, or those of one color, which
// share no moving body. REST: one group does the colors that are no wider than it, one after the other.
// Twin: solve().
#ifdef REST
#define SHARED coherent
#else
#define SHARED
#endif
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) SHARED buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_TENSORS) readonly buffer Tensors { SphereTensor tensors[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_COLORS) readonly buffer Colors { uint color_starts[]; };
layout(std430, binding = BIND_ORDER) buffer Order { SphereOrdered order[]; };
layout(std430, binding = BIND_ROWS) buffer Rows { vec4 rows[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_MOTIONS) SHARED buffer Motions { SphereMotion motions[]; };

uniform uint stage, color, current_sub_step;
uniform uint only_cold;  // a sweep of the first steps of a world

#define velocity_of(i) states[world.bodies.x + (i)].velocity
#define spin_of(i) states[world.bodies.x + (i)].spin
#define moved_of(i) motions[i].moved
#define turned_of(i) motions[i].turned
#include "sphere/body.h"
#include "sphere/solve_manifold.h"
#include "sphere/large/large_world.h"

uint start_of(uint c) { return color_starts[large_world * (SPHERE_COLORS + 1u) + c]; }

#ifdef REST
// The last color is that of manifolds which share bodies: one invocation takes them in order.
void sweep_rest() {
  uint all = start_of(SPHERE_COLORS);
  for (uint c = large.narrow_color; start_of(c) < all; ++c) {
    bool alone = c == SPHERE_COLORS - 1u;
    uint stride = alone ? 1u : SPHERE_GROUP, end = start_of(c + 1u);
    if (!alone || gl_LocalInvocationIndex == 0u)
      for (uint o = start_of(c) + gl_LocalInvocationIndex; o < end; o += stride) solve_manifold(o, stage);
    memoryBarrierBuffer();
    barrier();
  }
}
#endif

void main() {
  world = worlds[large_world];
  if (idle() || stage == SWEEP_BOUNCE && large.bounced == 0u) return;
  if (only_cold == 1u && progress[large_world].cold_steps == 0u) return;
  take_sub_step_of(large_world, current_sub_step);
#ifdef REST
  sweep_rest();
#else
  bool sweeps = stage <= SWEEP_BOUNCE;
  uint o = thread_index() + (sweeps ? start_of(color) : 0u);
  if (o >= (sweeps ? start_of(color + 1u) : progress[large_world].ordered)) return;
  if (sweeps)
    solve_manifold(o, stage);
  else if (stage == MANIFOLDS_PREPARE)
    prepare_manifold(o);
  else if (stage == MANIFOLDS_NOTE)
    note_sliding(o);
  else if (stage == MANIFOLDS_KEEP)
    keep_forces(o);
  else if (bounces(o))
    large.bounced = 1u;
#endif
}
