// One group a world: an island of bodies joined by pressing contacts sleeps when all of them stayed where they are for
// the rest window; a moving body that presses on a sleeping one wakes the whole island. Labels spread over manifolds to
// the lowest body of each island; walls and fixed bodies join nothing. By part a body that moved recently keeps only
// itself and those that press on it awake; by touch one that moves on wakes all that have contacts with it. Ends the
// step. Twin: update_sleep().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) readonly buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };

#include "sphere/body.h"
#include "sphere/rest.h"
#include "sphere/no_jobs.h"

shared uint label[SPHERE_MAX_BODIES];
shared uint motion[SPHERE_MAX_BODIES];      // MOVED_RECENTLY, WENT_ON
shared uint kept_awake[SPHERE_MAX_BODIES];  // 1: itself, or its island; all write the same
shared uint changed[2];                     // take turns

const uint MOVED_RECENTLY = 1u, WENT_ON = 2u;

// While others may lower it.
uint label_now(uint i) { return atomicOr(label[i], 0u); }

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  if (thread == 0u) status = no_jobs();  // all are done; every group writes the same
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint count = progress[w].pairs, list = 2u * world.pairs.x + progress[w].page * world.pairs.y;

  for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP) {
    uint body = world.bodies.x + i;
    if (moves(body)) note_motion(body, w);
    label[i] = i;
    motion[i] = (moved_recently(body) ? MOVED_RECENTLY : 0u) | (went_on(body) ? WENT_ON : 0u);
    kept_awake[i] = 0u;
  }
  if (thread < 2u) changed[thread] = 0u;
  barrier();
  bool by_part = progress[w].sleep == SPHERE_SLEEP_BY_PART, by_touch = progress[w].sleep == SPHERE_SLEEP_BY_TOUCH;
  for (uint round = 0u;; ++round) {
    uint turn = round & 1u;
    for (uint p = thread; p < count; p += SPHERE_WORLD_GROUP) {
      SpherePair pair = pairs[list + p];
      if (pair.b == SPHERE_GROUND) continue;
      uvec4 manifold = manifolds[world.pairs.x + pair.slot].state;
      if ((by_touch ? manifold.x : manifold.y) == 0u) continue;
      if (bodies[pair.a].material.x == 0.0 || bodies[pair.b].material.x == 0.0) continue;
      uint a = pair.a - world.bodies.x, b = pair.b - world.bodies.x;
      if (by_part || by_touch) {
        if (((motion[a] | motion[b]) & (by_touch ? WENT_ON : MOVED_RECENTLY)) != 0u) kept_awake[a] = kept_awake[b] = 1u;
        continue;
      }
      uint la = label_now(a), lb = label_now(b);
      if (la == lb) continue;
      atomicMin(label[a], lb);
      atomicMin(label[b], la);
      atomicMin(label[max(la, lb)], min(la, lb));
      changed[turn] = 1u;
    }
    barrier();
    if (changed[turn] == 0u) break;
    for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP) atomicMin(label[i], label_now(label_now(i)));
    if (thread == 0u) changed[turn ^ 1u] = 0u;
    barrier();
  }
  for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP)
    if ((motion[i] & MOVED_RECENTLY) != 0u) kept_awake[label[i]] = 1u;
  barrier();
  for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP)
    settle(world.bodies.x + i, world.bodies.x + label[i], kept_awake[label[i]] == 1u, w);
  if (thread == 0u) {
    if (--progress[w].cuts_left == 0u) --progress[w].steps_left;
    if (progress[w].cold_steps != 0u) --progress[w].cold_steps;
    progress[w].forgets = 0u;
    ++progress[w].steps;
  }
}
