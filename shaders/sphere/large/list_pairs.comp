// Pairs of a large world, an invocation a body: those with bodies of higher number in the cells around it, counted
// first, listed when the counts are summed up. Each body sorts its own, so the list is that of one group: by (a, b).
// Manifolds of the last step keep their slot; those of pairs that parted give theirs back. Twin: find_pairs().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_RANGES) buffer Ranges { uvec4 ranges[]; };
layout(std430, binding = BIND_PAIRS) buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_FREE) buffer Free { uint free_slots[]; };
layout(std430, binding = BIND_MANIFOLDS) readonly buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_BOXES) readonly buffer Boxes { SphereBox boxes[]; };
layout(std430, binding = BIND_CELL_STARTS) readonly buffer CellStarts { uint cell_starts[]; };
layout(std430, binding = BIND_SORTED) readonly buffer Sorted { uint sorted[]; };
layout(std430, binding = BIND_PAIR_COUNTS) writeonly buffer PairCounts { uint pair_counts[]; };
layout(std430, binding = BIND_PAIR_STARTS) readonly buffer PairStarts { uint pair_starts[]; };

#include "sphere/body.h"
#include "sphere/pair_list.h"
#include "sphere/oriented_box.h"
#include "sphere/large/large_world.h"
#include "sphere/large/cell.h"

uniform uint stage;  // LIST_COUNT, LIST_PLACE

SphereWorld world;
uint own, count, first;  // body; pairs found, and where they go
SphereBox own_box;

void add(uint b) {
  if (stage == LIST_PLACE) pairs[first + count] = SpherePair(world.bodies.x + own, b, NO_SLOT, 0u);
  ++count;
}

void test(uint j) {
  if (j <= own) return;
  SphereBox box = boxes[j];
  if (boxes_meet(world.bodies.x + own, Box(own_box.center, own_box.half_size), world.bodies.x + j,
                 Box(box.center, box.half_size)))
    add(world.bodies.x + j);
}

void test_cells() {
  ivec3 middle = own_box.cell.xyz;
  for (int k = 0; k < 27; ++k) {
    ivec3 cell = middle + ivec3(k % 3, k / 3 % 3, k / 9) - 1;
    uint bucket = bucket_of(cell);
    for (uint at = cell_starts[bucket]; at < cell_starts[bucket + 1u]; ++at) {
      uint j = sorted[at];
      if (boxes[j].cell.xyz == cell) test(j);  // another cell may share the bucket
    }
  }
  for (uint k = 0u; k < large.big; ++k) test(sorted[world.bodies.y - 1u - k]);
}

// Old pairs of which neither body moves stay.
void add_waiting(uvec2 old, uint old_list) {
  for (uint p = old.x; p < old.y; ++p) {
    SpherePair pair = pairs[old_list + p];
    if (waits(pair.a) && (pair.b == SPHERE_GROUND || waits(pair.b))) add(pair.b);
  }
}

void sort_own() {
  for (uint n = 1u; n < count; ++n) {
    SpherePair pair = pairs[first + n];
    uint at = n;
    for (; at > 0u && pairs[first + at - 1u].b > pair.b; --at) pairs[first + at] = pairs[first + at - 1u];
    pairs[first + at] = pair;
  }
}

void give_back(uint slot) {
  free_slots[world.pairs.x + atomicAdd(progress[large_world].free_slots, 1u)] = slot;
}

void keep_slots(uvec2 old, uint old_list) {
  uint n = 0u;
  for (uint p = old.x; p < old.y; ++p) {
    SpherePair pair = pairs[old_list + p];
    while (n < count && pairs[first + n].b < pair.b) ++n;
    if (n < count && pairs[first + n].b == pair.b)
      pairs[first + n].slot = pair.slot;
    else
      give_back(pair.slot);
  }
}

void main() {
  own = thread_index();
  world = worlds[large_world];
  uint bodies_in_world = world.bodies.y;
  bool too_many = stage == LIST_PLACE && pair_starts[bodies_in_world] > world.pairs.y;
  if (too_many && own != 0u) return;  // does not ask what the first one changes
  if (idle()) return;
  if (too_many) {
    progress[large_world].need = pair_starts[bodies_in_world];
    progress[large_world].overflow = SPHERE_PAIR_OVERFLOW;
    return;
  }
  if (own >= bodies_in_world) return;
  uint page = progress[large_world].page, old_list = list_of(world, page), list = list_of(world, page ^ 1u);
  uvec2 old = range_of(world.bodies.x + own, page);
  own_box = boxes[own];
  count = 0u;
  first = stage == LIST_COUNT ? 0u : list + pair_starts[own];
  if (own_box.half_size.x >= 0.0) {
    if (own_box.cell.w == 1)
      test_cells();
    else
      for (uint j = own + 1u; j < bodies_in_world; ++j) test(j);
    if (own_box.half_size.w == 2.0) add(SPHERE_GROUND);
  }
  add_waiting(old, old_list);
  if (stage == LIST_COUNT) {
    pair_counts[own] = count;
    return;
  }
  sort_own();
  keep_slots(old, old_list);
  set_range(world.bodies.x + own, page ^ 1u, uvec2(first, first + count) - list);
}
