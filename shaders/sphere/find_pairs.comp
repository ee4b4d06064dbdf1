// One group a world: upright boxes of its bodies, every two of them against each other, then oriented boxes. The hits
// are bits, one row a body, so that the list of pairs comes out sorted by (a, b) and manifolds of the last step are
// found by walking two sorted lists. Pairs of bodies that do not move are left out, unless they were in contact
// already: their manifold waits, untouched, until one of them wakes. Twin: find_pairs() and recyclable().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_PLANES) readonly buffer Planes { SpherePlane planes[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_TENSORS) writeonly buffer Tensors { SphereTensor tensors[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_NEAR) coherent buffer Near { uint near[]; };
layout(std430, binding = BIND_RANGES) buffer Ranges { uvec4 ranges[]; };  // pairs of a body: first, end, by page
layout(std430, binding = BIND_PAIRS) buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_FREE) coherent buffer Free { uint free_slots[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) readonly buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/pair_list.h"
#include "sphere/oriented_box.h"
#include "sphere/box.h"
#include "sphere/pair_job.h"
#include "shared/language.h"
#include "shared/sphere/cut.h"
#include "sphere/speed.h"

shared vec4 box_center[SPHERE_MAX_BODIES];
shared vec4 box_half[SPHERE_MAX_BODIES];  // as in struct Box
shared uint on_ground[SPHERE_MAX_BODIES];
shared uint first_pair[SPHERE_MAX_BODIES];
shared uint partial[SPHERE_WORLD_GROUP];
shared uint box_queue[SPHERE_BOX_QUEUE], queued;
shared uint free_top, fastest, fastest_turn;  // bits of m/s, rad/s

void find_box(SphereWorld world, uint i) {
  uint body = world.bodies.x + i;
  Box box = box_of(world, body);
  if (present(body)) tensors[body] = tensor_of(body);
  box_center[i] = box.center;
  box_half[i] = box.half_size;
  on_ground[i] = box.half_size.w == 2.0 ? 1u : 0u;
}

bool oriented_boxes_meet(SphereWorld world, uint i, uint j) {
  return !oriented_boxes_apart(world.bodies.x + i, world.bodies.x + j, box_center[i].w + box_center[j].w);
}

// Bodies near body i with numbers in word k of its row of bits; those for whose oriented boxes the queue has room are yet
// to come.
uint near_word(SphereWorld world, uint i, uint k) {
  uint word = 0u;
  for (uint j = max(32u * k, i + 1u); j < min(32u * k + 32u, world.bodies.y); ++j) {
    if (!upright_boxes_meet(Box(box_center[i], box_half[i]), Box(box_center[j], box_half[j]))) continue;
    uint at = atomicAdd(queued, 1u);
    if (at < SPHERE_BOX_QUEUE)
      box_queue[at] = i << 16 | j;
    else if (oriented_boxes_meet(world, i, j))
      word |= 1u << (j & 31u);
  }
  return word;
}

uint word_of(SphereWorld world, uint i, uint k) { return world.bodies.w + i * world.bodies.z + k; }

// Upright boxes of every two bodies, then the oriented boxes of those few that meet, by as many invocations as there are.
void find_near(SphereWorld world) {
  uint thread = gl_LocalInvocationIndex;
  for (uint item = thread; item < world.bodies.y * world.bodies.z; item += SPHERE_WORLD_GROUP) {
    uint i = item / world.bodies.z, k = item % world.bodies.z;
    near[word_of(world, i, k)] = near_word(world, i, k);
  }
  memoryBarrierBuffer();
  barrier();
  for (uint q = thread; q < min(queued, SPHERE_BOX_QUEUE); q += SPHERE_WORLD_GROUP) {
    uint i = box_queue[q] >> 16, j = box_queue[q] & 0xffffu;
    if (oriented_boxes_meet(world, i, j)) atomicOr(near[word_of(world, i, j >> 5)], 1u << (j & 31u));
  }
  memoryBarrierBuffer();
  barrier();
}

bool kept(SphereWorld world, uint i, uint b) {
  if (b == SPHERE_GROUND) return on_ground[i] == 1u;
  uint j = b - world.bodies.x;
  return (near[word_of(world, i, j >> 5)] >> (j & 31u) & 1u) == 1u;
}

// Old pairs of i of which neither body moves stay; returns the number of pairs of i.
uint keep_waiting(SphereWorld world, uint i, uint page, uint list) {
  uvec2 old = range_of(world.bodies.x + i, page);
  for (uint p = old.x; p < old.y; ++p) {
    SpherePair pair = pairs[list + p];
    if (!waits(pair.a) || pair.b != SPHERE_GROUND && !waits(pair.b)) continue;
    uint j = pair.b - world.bodies.x;
    if (pair.b == SPHERE_GROUND)
      on_ground[i] = 1u;
    else
      near[word_of(world, i, j >> 5)] |= 1u << (j & 31u);
  }
  uint count = on_ground[i];
  for (uint k = 0u; k < world.bodies.z; ++k) count += uint(bitCount(near[word_of(world, i, k)]));
  return count;
}

// Turns the counts in first_pair into where the pairs of each body begin, known to all behind the next barrier; returns
// their sum.
uint scan_counts(uint count) {
  uint thread = gl_LocalInvocationIndex, chunk = (count + SPHERE_WORLD_GROUP - 1u) / SPHERE_WORLD_GROUP, sum = 0u;
  for (uint i = thread * chunk; i < min((thread + 1u) * chunk, count); ++i) sum += first_pair[i];
  partial[thread] = sum;
  barrier();
  uint before = 0u, total = 0u;
  for (uint k = 0u; k < SPHERE_WORLD_GROUP; ++k) {
    if (k < thread) before += partial[k];
    total += partial[k];
  }
  for (uint i = thread * chunk; i < min((thread + 1u) * chunk, count); ++i) {
    uint own = first_pair[i];
    first_pair[i] = before;
    before += own;
  }
  return total;
}

void retire(SphereWorld world, uint i, uint page, uint list) {
  uvec2 old = range_of(world.bodies.x + i, page);
  for (uint p = old.x; p < old.y; ++p) {
    if (kept(world, i, pairs[list + p].b)) continue;
    free_slots[world.pairs.x + atomicAdd(free_top, 1u)] = pairs[list + p].slot;
  }
}

// Where a body's pairs are: those of the last step that are not past yet, and the next one of this step.
struct Places {
  uint old, old_end, next;
};

// Appends the pair of i with b.
void adopt(SphereWorld world, uint w, uint i, uint b, inout Places places) {
  while (places.old < places.old_end && pairs[places.old].b < b) ++places.old;
  SpherePair pair = SpherePair(world.bodies.x + i, b, 0u, 0u);
  if (places.old < places.old_end && pairs[places.old].b == b) {
    pair.slot = pairs[places.old].slot;
    if (progress[w].refresh != 0u) manifolds[world.pairs.x + pair.slot].state.z = 0u;
  } else {
    pair.slot = free_slots[world.pairs.x + atomicAdd(free_top, 0xffffffffu) - 1u];
    manifolds[world.pairs.x + pair.slot].state = uvec4(0u);
  }
  pairs[places.next] = pair;
  enlist(world, w, pair, places.next++);
}

// How long this step is: whole steps are cut by what is fast when they begin.
void cut_step(SphereWorld world, uint w) {
  bool begins = progress[w].cuts_left == 0u;
  if (gl_LocalInvocationIndex == 0u) fastest = fastest_turn = 0u;
  barrier();
  for (uint i = gl_LocalInvocationIndex; begins && i < world.bodies.y; i += SPHERE_WORLD_GROUP) {
    if (!moves(world.bodies.x + i)) continue;
    vec2 speeds = speeds_of(world.bodies.x + i);
    atomicMax(fastest, floatBitsToUint(speeds.x));
    atomicMax(fastest_turn, floatBitsToUint(speeds.y));
  }
  barrier();
  uint cuts = cuts_of(vec2(uintBitsToFloat(fastest), uintBitsToFloat(fastest_turn)), world.ground.w);
  time_step = begins ? settings.time_step / float(cuts) : progress[w].time_step;
  if (gl_LocalInvocationIndex != 0u || !begins) return;
  progress[w].time_step = time_step;
  progress[w].cuts_left = cuts;
}

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint page = progress[w].page, count = world.bodies.y;
  uint old_list = list_of(world, page), list = list_of(world, page ^ 1u);

  cut_step(world, w);
  for (uint i = thread; i < count; i += SPHERE_WORLD_GROUP) {
    find_box(world, i);
    if (sleeps(world.bodies.x + i)) ++sleepers;
  }
  if (thread == 0u) queued = 0u;
  barrier();
  find_near(world);
  for (uint i = thread; i < count; i += SPHERE_WORLD_GROUP) first_pair[i] = keep_waiting(world, i, page, old_list);
  if (thread == 0u) free_top = progress[w].free_slots;
  barrier();
  uint total = scan_counts(count);
  if (total > world.pairs.y) {
    if (thread == 0u) {
      progress[w].overflow = SPHERE_PAIR_OVERFLOW;
      progress[w].need = total;
    }
    return;
  }

  for (uint i = thread; i < count; i += SPHERE_WORLD_GROUP) retire(world, i, page, old_list);
  memoryBarrierBuffer();
  barrier();
  for (uint i = thread; i < count; i += SPHERE_WORLD_GROUP) {
    uvec2 old = range_of(world.bodies.x + i, page);
    Places places = Places(old_list + old.x, old_list + old.y, list + first_pair[i]);
    for (uint k = 0u; k < world.bodies.z; ++k)
      for (uint word = near[word_of(world, i, k)]; word != 0u; word &= word - 1u) {
        uint j = 32u * k + uint(findLSB(word));
        adopt(world, w, i, world.bodies.x + j, places);
      }
    if (on_ground[i] == 1u) adopt(world, w, i, SPHERE_GROUND, places);
    set_range(world.bodies.x + i, page ^ 1u, uvec2(first_pair[i], places.next - list));
  }
  count_pairs(w);
  barrier();  // all have read progress
  if (thread == 0u) {
    progress[w].page = page ^ 1u;
    progress[w].pairs = total;
    progress[w].free_slots = free_top;
    progress[w].refresh = 0u;
  }
}
