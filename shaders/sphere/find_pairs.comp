// One group a world: the pairs of bodies whose boxes meet, upright ones first, then oriented ones. Tested are the pairs
// of a list of those that may come near, which is made anew when a body leaves the box that it has there
// (sphere/listed.h); it holds them in the order of (a, b), and so the list of pairs is sorted, and manifolds of the last
// step are found by walking two sorted lists. Pairs of bodies that do not move are left out, unless they were in contact
// already: their manifold waits, untouched, until one of them wakes. Where no pair begins or ends, the list of pairs
// stays as it is. Twin: find_pairs().
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
layout(std430, binding = BIND_BOXES) buffer Boxes { SphereBox boxes[]; };
layout(std430, binding = BIND_RANGES) buffer Ranges { uvec4 ranges[]; };  // pairs of a body: first, end, by page
layout(std430, binding = BIND_PAIRS) buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_FREE) coherent buffer Free { uint free_slots[]; };
layout(std430, binding = BIND_MANIFOLDS) writeonly buffer Manifolds { SphereManifold manifolds[]; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/pair_list.h"
#include "sphere/oriented_box.h"
#include "sphere/box.h"
#include "sphere/listed.h"
#include "shared/language.h"
#include "shared/sphere/cut.h"
#include "sphere/speed.h"

shared vec4 box_center[SPHERE_MAX_BODIES];
shared vec4 box_half[SPHERE_MAX_BODIES];  // as in struct Box
shared uint first_of_body[SPHERE_MAX_BODIES];
shared uint partial[SPHERE_WORLD_GROUP];
shared uint free_top, fastest, fastest_turn;  // bits of m/s, rad/s
shared uint left_its_box, changed, sleepers;
#define FOR_OWN(i, count) for (uint i = gl_LocalInvocationIndex; i < (count); i += SPHERE_WORLD_GROUP)

Box box_at(uint i) { return Box(box_center[i], box_half[i]); }
void set_box(uint i, Box box) {
  box_center[i] = box.center;
  box_half[i] = box.half_size;
}
bool is_present(uint i) { return box_half[i].x >= 0.0; }
bool can_meet(uint i, uint j) { return upright_boxes_meet(box_at(i), box_at(j)); }

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

// Turns the counts in first_of_body into where what is counted begins for each body, known to all behind the next
// barrier; returns their sum.
uint scan_counts(uint count) {
  uint thread = gl_LocalInvocationIndex, chunk = (count + SPHERE_WORLD_GROUP - 1u) / SPHERE_WORLD_GROUP, own = 0u;
  for (uint i = thread * chunk; i < min((thread + 1u) * chunk, count); ++i) own += first_of_body[i];
  partial[thread] = own;
  barrier();
  for (uint reach = 1u; reach < SPHERE_WORLD_GROUP; reach *= 2u) {  // Hillis and Steele 1986
    uint before = thread >= reach ? partial[thread - reach] : 0u;
    barrier();
    partial[thread] += before;
    barrier();
  }
  uint before = partial[thread] - own;
  for (uint i = thread * chunk; i < min((thread + 1u) * chunk, count); ++i) {
    uint here = first_of_body[i];
    first_of_body[i] = before;
    before += here;
  }
  return partial[SPHERE_WORLD_GROUP - 1u];
}

// Bits of the bodies behind i with numbers in word k of its row that may come near it.
uint near_word(SphereWorld world, uint i, uint k) {
  uint word = 0u;
  for (uint j = max(32u * k, i + 1u); j < min(32u * k + 32u, world.bodies.y); ++j)
    if (can_meet(i, j)) word |= 1u << (j & 31u);
  return word;
}

// Adds what is in the list of pairs, wherever it is; returns how many entries body i has.
uint count_entries(SphereWorld world, uint i, uint page, uint list) {
  uvec2 old = range_of(world.bodies.x + i, page);
  for (uint p = old.x; p < old.y; ++p) {
    uint b = pairs[list + p].b;
    if (b == SPHERE_GROUND) continue;
    uint j = b - world.bodies.x;
    near[word_of(world, i, j >> 5)] |= 1u << (j & 31u);
  }
  uint count = box_half[i].w > 0.0 ? 1u : 0u;  // the ground
  for (uint k = 0u; k < world.bodies.z; ++k) count += uint(bitCount(near[word_of(world, i, k)]));
  return count;
}

// Marked as in the list of pairs, if that is where `old` is; moves `old` on.
uint marked(SphereWorld world, uint entry, inout uint old, uint old_end) {
  if (old == old_end || entry_of(world, pairs[old]) != entry) return entry;
  ++old;
  return entry | IN_PAIRS;
}

void write_entries(SphereWorld world, uint i, uint page, uint list) {
  uvec2 pairs_of_i = list + range_of(world.bodies.x + i, page);
  uint old = pairs_of_i.x, at = list_of_near(world) + first_of_body[i];
  boxes[world.bodies.x + i].first = first_of_body[i];
  for (uint k = 0u; k < world.bodies.z; ++k)
    for (uint word = near[word_of(world, i, k)]; word != 0u; word &= word - 1u)
      near[at++] = marked(world, i << 16 | 32u * k + uint(findLSB(word)), old, pairs_of_i.y);
  if (box_half[i].w > 0.0) near[at++] = marked(world, i << 16 | GROUND_ENTRY, old, pairs_of_i.y);
  boxes[world.bodies.x + i].end = at - list_of_near(world);
}

// Makes the list anew; returns how many entries it has. The boxes are those of the list meanwhile.
uint list_anew(SphereWorld world, uint w, uint page, uint list) {
  FOR_OWN(i, world.bodies.y) {
    uint body = world.bodies.x + i;
    Box box = listed_box(world, body, box_at(i));
    boxes[body].center = box.center.xyz;
    boxes[body].half_size = box.half_size.xyz;
    set_box(i, Box(box.center, vec4(rounded_up(box), box.half_size.w)));
  }
  barrier();
  FOR_OWN(item, world.bodies.y * world.bodies.z) {
    uint i = item / world.bodies.z, k = item % world.bodies.z;
    near[word_of(world, i, k)] = near_word(world, i, k);
  }
  memoryBarrierBuffer();
  barrier();
  FOR_OWN(i, world.bodies.y) first_of_body[i] = count_entries(world, i, page, list);
  barrier();
  uint entries = scan_counts(world.bodies.y);
  barrier();
  FOR_OWN(i, world.bodies.y) {
    write_entries(world, i, page, list);
    set_box(i, box_of(world, world.bodies.x + i));
  }
  memoryBarrierBuffer();
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    progress[w].listed = entries;
    ++progress[w].lists_made;
  }
  return entries;
}

// Whether the pair of an entry belongs to the list of pairs.
bool belongs(SphereWorld world, uint entry) {
  bool ground = second_of(entry) == GROUND_ENTRY;
  uint a = first_of(entry), b = ground ? a : second_of(entry);  // in range: compilers read ahead of conditions
  bool waits = box_half[a].w == 0.0 && box_half[b].w == 0.0;
  if (waits) return (entry & IN_PAIRS) != 0u && is_present(a) && is_present(b);
  if (ground) return box_half[a].w == 2.0;
  return can_meet(a, b) &&
         !oriented_boxes_apart(world.bodies.x + a, world.bodies.x + b, box_center[a].w + box_center[b].w);
}

uint count_pairs_of(SphereWorld world, uint i) {
  uint count = 0u, list = list_of_near(world);
  for (uint e = boxes[world.bodies.x + i].first; e < boxes[world.bodies.x + i].end; ++e) count += near[list + e] >> 31;
  return count;
}

// Gives the manifolds of pairs that end back.
void retire(SphereWorld world, uint i, uint page, uint list) {
  uvec2 old = list + range_of(world.bodies.x + i, page);
  uint at = list_of_near(world) + boxes[world.bodies.x + i].first;
  for (uint p = old.x; p < old.y; ++p, ++at) {
    uint entry = entry_of(world, pairs[p]);
    while ((near[at] & ~IN_PAIRS) != entry) ++at;  // each pair of the last step has an entry
    if ((near[at] & IN_PAIRS) == 0u) free_slots[world.pairs.x + atomicAdd(free_top, 1u)] = pairs[p].slot;
  }
}

// Writes the pairs of body i into the other page.
void adopt(SphereWorld world, uint i, uint page, uint old_list, uint list) {
  uvec2 old = old_list + range_of(world.bodies.x + i, page);
  uint entries = list_of_near(world), next = list + first_of_body[i];
  for (uint e = boxes[world.bodies.x + i].first; e < boxes[world.bodies.x + i].end; ++e) {
    uint entry = near[entries + e], b = second_of(entry);
    if ((entry & IN_PAIRS) == 0u) continue;
    SpherePair pair =
        SpherePair(world.bodies.x + i, b == GROUND_ENTRY ? SPHERE_GROUND : world.bodies.x + b, 0u, SPHERE_NO_COLOR);
    while (old.x < old.y && pairs[old.x].b < pair.b) ++old.x;
    if (old.x < old.y && pairs[old.x].b == pair.b) {
      pair = pairs[old.x];
    } else {
      pair.slot = free_slots[world.pairs.x + atomicAdd(free_top, 0xffffffffu) - 1u];
      manifolds[world.pairs.x + pair.slot].state = uvec4(0u);
    }
    pairs[next++] = pair;
  }
  set_range(world.bodies.x + i, page ^ 1u, uvec2(first_of_body[i], next - list));
}

// Some pairs begin or end.
void change_pairs(SphereWorld world, uint w, uint page) {
  uint count = world.bodies.y, old_list = list_of(world, page), list = list_of(world, page ^ 1u);
  FOR_OWN(i, count) first_of_body[i] = count_pairs_of(world, i);
  if (gl_LocalInvocationIndex == 0u) free_top = progress[w].free_slots;
  barrier();
  uint total = scan_counts(count);
  if (total > world.pairs.y) {
    if (gl_LocalInvocationIndex != 0u) return;
    progress[w].overflow = SPHERE_PAIR_OVERFLOW;
    progress[w].need = total;
    progress[w].listed = 0u;  // its marks are of pairs for which there is no room
    return;
  }
  FOR_OWN(i, count) retire(world, i, page, old_list);
  memoryBarrierBuffer();
  barrier();
  FOR_OWN(i, count) adopt(world, i, page, old_list, list);
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  progress[w].page = page ^ 1u;
  progress[w].pairs = total;
  progress[w].free_slots = free_top;
}

void main() {
  uint w = running[gl_WorkGroupID.x];
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint page = progress[w].page, old_list = list_of(world, page);
  bool refresh = progress[w].refresh != 0u;

  cut_step(world, w);
  if (gl_LocalInvocationIndex == 0u) {
    left_its_box = progress[w].listed == 0u ? 1u : 0u;
    changed = sleepers = 0u;
  }
  barrier();
  FOR_OWN(i, world.bodies.y) {
    uint body = world.bodies.x + i;
    Box box = box_of(world, body);
    set_box(i, box);
    if (present(body)) tensors[body] = tensor_of(body);
    if (!is_listed(boxes[body], box)) left_its_box = 1u;
    if (sleeps(body)) atomicAdd(sleepers, 1u);
  }
  barrier();
  uint list = list_of_near(world), entries = left_its_box != 0u ? list_anew(world, w, page, old_list) : progress[w].listed;
  FOR_OWN(e, entries) {
    uint entry = near[list + e];
    bool marked = (entry & IN_PAIRS) != 0u;
    if (belongs(world, entry) == marked) continue;
    near[list + e] = entry ^ IN_PAIRS;
    changed = 1u;
  }
  if (refresh)  // finer or coarser samples: contacts of the last step are void
    FOR_OWN(p, progress[w].pairs) manifolds[world.pairs.x + pairs[old_list + p].slot].state.z = 0u;
  memoryBarrierBuffer();
  barrier();
  if (changed != 0u) change_pairs(world, w, page);
  if (gl_LocalInvocationIndex != 0u || progress[w].overflow != 0u) return;
  progress[w].asleep_steps += sleepers;
  progress[w].refresh = 0u;
}
