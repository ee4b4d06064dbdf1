// One group a world: upright boxes of its bodies, every two of them against each other, then oriented boxes. The hits
// are bits, one row a body, so that the list of pairs comes out sorted by (a, b) and manifolds of the last step are
// found by walking two sorted lists. Pairs of bodies that do not move are left out, unless they were in contact
// already: their manifold waits, untouched, until one of them wakes. Twin: find_pairs() and recyclable().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_GROUP) in;

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
layout(std430, binding = BIND_CONTACTS) coherent buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; uint jobs[]; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/pair_list.h"
#include "sphere/contact_place.h"

shared vec4 box_center[SPHERE_MAX_BODIES];  // w: margin
shared vec4 box_half[SPHERE_MAX_BODIES];    // margin included, negative: absent; w: 1 = moves
shared uint on_ground[SPHERE_MAX_BODIES];
shared uint first_pair[SPHERE_MAX_BODIES];
shared uint partial[SPHERE_GROUP];
shared uint free_top, free_contact_top;

void find_box(SphereWorld world, uint i) {
  uint body = world.bodies.x + i;
  on_ground[i] = 0u;
  box_half[i] = vec4(-1e30, -1e30, -1e30, 0.0);
  box_center[i] = vec4(0.0);
  if (!present(body)) return;
  SphereBody fixed_part = bodies[body];
  mat3 r = rotation_of(states[body].orientation);
  mat3 tensor = r * symmetric(fixed_part.inverse_inertia, fixed_part.inverse_inertia_mixed) * transpose(r);
  tensors[body].diagonal = vec4(tensor[0][0], tensor[1][1], tensor[2][2], 0.0);
  tensors[body].mixed = vec4(tensor[0][1], tensor[0][2], tensor[1][2], 0.0);
  tensors[body].orientation = states[body].orientation;

  vec4 center = shapes[fixed_part.ids.x].box_center, half_size = shapes[fixed_part.ids.x].box_half;
  float margin = reach(world, body, center.w, half_size.w);
  vec3 middle = states[body].position.xyz + r * center.xyz;
  vec3 extent = magnitudes(r) * half_size.xyz + margin;
  bool moving = moves(body);
  box_center[i] = vec4(middle, margin);
  box_half[i] = vec4(extent, moving ? 1.0 : 0.0);
  if (!moving) return;
  for (uint k = 0u; k < world.pairs.w; ++k) {
    vec4 plane = planes[world.pairs.z + k].plane;
    if (dot(plane.xyz, middle) - dot(abs(plane.xyz), extent) < plane.w) on_ground[i] = 1u;
  }
}

bool boxes_meet(SphereWorld world, uint i, uint j) {
  if (any(greaterThan(abs(box_center[i].xyz - box_center[j].xyz), box_half[i].xyz + box_half[j].xyz))) return false;
  if (box_half[i].w + box_half[j].w == 0.0) return false;
  return !oriented_boxes_apart(world.bodies.x + i, world.bodies.x + j, box_center[i].w + box_center[j].w);
}

// Bodies near body i with numbers in word k of its row of bits.
uint near_word(SphereWorld world, uint i, uint k) {
  uint word = 0u;
  for (uint j = max(32u * k, i + 1u); j < min(32u * k + 32u, world.bodies.y); ++j)
    if (boxes_meet(world, i, j)) word |= 1u << (j & 31u);
  return word;
}

uint word_of(SphereWorld world, uint i, uint k) { return world.bodies.w + i * world.bodies.z + k; }

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

// Turns the counts in first_pair into where the pairs of each body begin; returns their sum.
uint scan_counts(uint count) {
  uint thread = gl_LocalInvocationIndex, chunk = (count + SPHERE_GROUP - 1u) / SPHERE_GROUP, sum = 0u;
  for (uint i = thread * chunk; i < min((thread + 1u) * chunk, count); ++i) sum += first_pair[i];
  partial[thread] = sum;
  barrier();
  uint before = 0u, total = 0u;
  for (uint k = 0u; k < SPHERE_GROUP; ++k) {
    if (k < thread) before += partial[k];
    total += partial[k];
  }
  for (uint i = thread * chunk; i < min((thread + 1u) * chunk, count); ++i) {
    uint own = first_pair[i];
    first_pair[i] = before;
    before += own;
  }
  barrier();
  return total;
}

void retire(SphereWorld world, uint i, uint page, uint list) {
  uvec2 old = range_of(world.bodies.x + i, page);
  for (uint p = old.x; p < old.y; ++p) {
    if (kept(world, i, pairs[list + p].b)) continue;
    uint slot = pairs[list + p].slot, n = manifolds[world.pairs.x + slot].state.x;
    free_slots[world.pairs.x + atomicAdd(free_top, 1u)] = slot;
    uint top = atomicAdd(free_contact_top, n);
    for (uint k = 0u, at = first_contact(world, slot); k < n; ++k, at = next_contact(world, at))
      set_free_place(world, top + k, at - world.contacts.x);
  }
}

// Puts the places that the last find_contacts gave up on the stack. Those that lie where the stack will reach stay.
void take_back_places(SphereWorld world, uint w) {
  uint top = progress[w].free_contacts, released = progress[w].released_contacts;
  uint moving = min(released, world.contacts.y - released - top);
  for (uint n = gl_LocalInvocationIndex; n < moving; n += SPHERE_GROUP)
    set_free_place(world, top + n, free_place(world, released_entry(world, n)));
  if (gl_LocalInvocationIndex == 0u) free_contact_top = top + released;
}

uint recycled = 0u, tested = 0u, asleep = 0u, sleepers = 0u;

// Appends the pair of i with b; `p` walks the old pairs of i.
void adopt(SphereWorld world, uint w, uint i, uint b, inout uint p, uvec2 old, uint old_list, uint list, uint at) {
  while (p < old.y && pairs[old_list + p].b < b) ++p;
  SpherePair pair = SpherePair(world.bodies.x + i, b, 0u, 0u);
  if (p < old.y && pairs[old_list + p].b == b) {
    pair.slot = pairs[old_list + p].slot;
    if (progress[w].refresh != 0u) manifolds[world.pairs.x + pair.slot].state.z = 0u;
  } else {
    pair.slot = free_slots[world.pairs.x + atomicAdd(free_top, 0xffffffffu) - 1u];
    manifolds[world.pairs.x + pair.slot].state = uvec4(0u);
  }
  pairs[list + at] = pair;
  bool awake = moves(pair.a) || b != SPHERE_GROUND && moves(b);
  if (!awake) {
    ++asleep;
    return;
  }
  ++tested;
  if (recyclable(manifolds[world.pairs.x + pair.slot], pair, progress[w].fine != 0u)) {
    ++recycled;
    return;
  }
  uint job = atomicAdd(status.jobs, 1u);
  jobs[job] = list + at;
  atomicMax(status.groups.x, job < settings.contact_groups ? job + 1u : job / SPHERE_GROUP_JOBS + 1u);
}

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint page = progress[w].page, count = world.bodies.y;
  uint old_list = list_of(world, page), list = list_of(world, page ^ 1u);

  for (uint i = thread; i < count; i += SPHERE_GROUP) {
    find_box(world, i);
    if (sleeps(world.bodies.x + i)) ++sleepers;
  }
  barrier();
  for (uint item = thread; item < count * world.bodies.z; item += SPHERE_GROUP) {
    uint i = item / world.bodies.z, k = item % world.bodies.z;
    near[word_of(world, i, k)] = near_word(world, i, k);
  }
  memoryBarrierBuffer();
  barrier();
  for (uint i = thread; i < count; i += SPHERE_GROUP) first_pair[i] = keep_waiting(world, i, page, old_list);
  if (thread == 0u) free_top = progress[w].free_slots;
  memoryBarrierBuffer();
  barrier();
  uint total = scan_counts(count);
  if (total > world.pairs.y) {
    if (thread == 0u) {
      progress[w].overflow = SPHERE_PAIR_OVERFLOW;
      progress[w].need = total;
    }
    return;
  }

  take_back_places(world, w);
  memoryBarrierBuffer();
  barrier();
  for (uint i = thread; i < count; i += SPHERE_GROUP) retire(world, i, page, old_list);
  memoryBarrierBuffer();
  barrier();
  for (uint i = thread; i < count; i += SPHERE_GROUP) {
    uvec2 old = range_of(world.bodies.x + i, page);
    uint at = first_pair[i], p = old.x;
    for (uint k = 0u; k < world.bodies.z; ++k)
      for (uint word = near[word_of(world, i, k)]; word != 0u; word &= word - 1u) {
        uint j = 32u * k + uint(findLSB(word));
        adopt(world, w, i, world.bodies.x + j, p, old, old_list, list, at++);
      }
    if (on_ground[i] == 1u) adopt(world, w, i, SPHERE_GROUND, p, old, old_list, list, at++);
    set_range(world.bodies.x + i, page ^ 1u, uvec2(first_pair[i], at));
  }
  atomicAdd(progress[w].pairs_tested, tested);
  atomicAdd(progress[w].pairs_recycled, recycled);
  atomicAdd(progress[w].pairs_asleep, asleep);
  atomicAdd(progress[w].asleep_steps, sleepers);
  barrier();  // all have read progress
  if (thread == 0u) {
    progress[w].page = page ^ 1u;
    progress[w].pairs = total;
    progress[w].free_slots = free_top;
    progress[w].free_contacts = free_contact_top;
    progress[w].released_contacts = 0u;
    progress[w].refresh = 0u;
  }
}
