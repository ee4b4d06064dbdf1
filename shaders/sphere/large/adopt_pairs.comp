// New pairs of a large world get slots, and pairs whose contacts are to be found become jobs.
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_RANGES) buffer Ranges { uvec4 ranges[]; };
layout(std430, binding = BIND_PAIRS) buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_FREE) buffer Free { uint free_slots[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) readonly buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/pair_list.h"
#include "sphere/pair_job.h"
#include "sphere/large/large_world.h"

void main() {
  uint i = thread_index();
  SphereWorld world = worlds[large_world];
  if (idle() || i >= world.bodies.y) return;
  time_step = progress[large_world].time_step;
  uint page = progress[large_world].page ^ 1u, list = list_of(world, page);
  uvec2 range = range_of(world.bodies.x + i, page);
  if (sleeps(world.bodies.x + i)) ++sleepers;
  for (uint p = list + range.x; p < list + range.y; ++p) {
    if (pairs[p].slot == NO_SLOT) {
      uint top = atomicAdd(progress[large_world].free_slots, 0xffffffffu);
      uint slot = free_slots[world.pairs.x + top - 1u];
      pairs[p].slot = slot;
      manifolds[world.pairs.x + slot].state = uvec4(0u);
    } else if (progress[large_world].refresh != 0u) {
      manifolds[world.pairs.x + pairs[p].slot].state.z = 0u;
    }
    enlist(world, large_world, pairs[p], p);
  }
  count_pairs(large_world);
}
