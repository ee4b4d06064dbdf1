// An invocation a pair: has its contacts found anew, unless both bodies wait or the pair has hardly moved since its
// contacts were found. The groups of a world lie behind each other, enough of them for its longest list of pairs.
// Twin: recyclable().
#include "shared/sphere.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_JOB_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) readonly buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) readonly buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/pair_job.h"
#include "sphere/plan.h"

uniform uint groups_of_a_world;

shared uint tested, recycled, asleep;
shared uint struck[SPHERE_JOB_GROUP];  // 1: a contact of the pair strikes
// Contacts that may strike: invocation of the pair, contact.
shared uint loose[SPHERE_JOB_GROUP * SPHERE_MAX_CONTACTS], loose_count;

// Contacts that press do not strike.
void add_loose(SphereWorld world, SpherePair pair) {
  uint slot = world.pairs.x + pair.slot, count = manifolds[slot].state.x, thread = gl_LocalInvocationIndex;
  for (uint k = 0u; k < count; ++k)
    if (!(contacts[SPHERE_MAX_CONTACTS * slot + k].force.x > 0.0))
      loose[atomicAdd(loose_count, 1u)] = thread * SPHERE_MAX_CONTACTS + k;
}

// Decides, but for whether the pair at `place` strikes.
void decide(SphereWorld world, uint w, uint place) {
  SpherePair pair = pairs[place];
  if (!moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b))) {
    atomicAdd(asleep, 1u);
    return;
  }
  atomicAdd(tested, 1u);
  uint fate = fate_of_contacts(world, pair, w);
  if (fate == FIND_ANEW)
    enlist(place);
  else
    atomicAdd(recycled, 1u);
  if (fate == RECYCLE_UNLESS_IT_STRIKES) add_loose(world, pair);
}

// An invocation a contact. The first that strikes puts its pair on the list after all. The last sweeps of a step look
// into the sub-step after it.
void find_strikes(SphereWorld world, uint w, uint first) {
  float seconds = time_step + plan_of(w).sub_step;
  for (uint item = gl_LocalInvocationIndex; item < loose_count; item += SPHERE_JOB_GROUP) {
    uint of = loose[item] / SPHERE_MAX_CONTACTS, k = loose[item] % SPHERE_MAX_CONTACTS;
    SpherePair pair = pairs[first + of];
    float least = STRIKE * recycle_limit(pair, w);
    SphereContact c = contacts[SPHERE_MAX_CONTACTS * (world.pairs.x + pair.slot) + k];
    if (!strikes(c, pair, seconds, least, 0.0) || atomicExchange(struck[of], 1u) == 1u) continue;
    atomicAdd(progress[w].pairs_recycled, 0xffffffffu);
    enlist(first + of);
  }
}

void main() {
  uint w = running[group_index() / groups_of_a_world], thread = gl_LocalInvocationIndex;
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint first = group_index() % groups_of_a_world * SPHERE_JOB_GROUP;
  if (first >= progress[w].pairs) return;
  SphereWorld world = worlds[w];
  time_step = progress[w].time_step;
  struck[thread] = 0u;
  if (thread == 0u) tested = recycled = asleep = loose_count = 0u;
  barrier();
  uint list = 2u * world.pairs.x + progress[w].page * world.pairs.y;
  if (first + thread < progress[w].pairs) decide(world, w, list + first + thread);
  barrier();
  find_strikes(world, w, list + first);
  if (thread != 0u) return;
  if (tested > 0u) atomicAdd(progress[w].pairs_tested, tested);
  if (recycled > 0u) atomicAdd(progress[w].pairs_recycled, recycled);
  if (asleep > 0u) atomicAdd(progress[w].pairs_asleep, asleep);
}
