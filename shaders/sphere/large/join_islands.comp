// Islands of a large world, an invocation a pair: those that press join their islands, lock-free, the higher root under
// the lower one (after Jaiganesh, Burtscher 2018, "A high-performance connected components implementation for GPUs").
// A root is the lowest body of its island, whoever came first. By part or by touch nobody is joined: a body that
// moved lately keeps those that press on it awake, or one that moves on wakes all that have contacts with it. Twin:
// kept_awake() of update_sleep().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) readonly buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_WORK) coherent buffer Work { SphereWork work[]; };

#include "sphere/body.h"
#include "sphere/rest.h"
#include "sphere/large/large_world.h"
#include "sphere/large/island.h"

void main() {
  SphereWorld world = worlds[large_world];
  if (idle() || thread_index() >= progress[large_world].pairs) return;
  SpherePair pair = pairs[large.list + thread_index()];
  if (pair.b == SPHERE_GROUND) return;
  uint sleep = progress[large_world].sleep;
  uvec4 manifold = manifolds[world.pairs.x + pair.slot].state;
  if ((sleep == SPHERE_SLEEP_BY_TOUCH ? manifold.x : manifold.y) == 0u) return;
  if (bodies[pair.a].material.x == 0.0 || bodies[pair.b].material.x == 0.0) return;
  if (sleep != SPHERE_SLEEP_BY_ISLAND) {
    bool by_touch = sleep == SPHERE_SLEEP_BY_TOUCH;
    if (by_touch ? went_on(pair.a) || went_on(pair.b) : moved_lately(pair.a) || moved_lately(pair.b))
      moved_lately_of(pair.a - world.bodies.x) = moved_lately_of(pair.b - world.bodies.x) = 1u;
    return;
  }
  uint a = root_of(pair.a - world.bodies.x), b = root_of(pair.b - world.bodies.x);
  while (a != b) {
    uint high = max(a, b), low = min(a, b), seen = atomicCompSwap(label_of(high), high, low);
    if (seen == high) return;
    a = root_of(seen);
    b = root_of(low);
  }
}
