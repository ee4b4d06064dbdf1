// One group a world: colors for the manifolds to solve, so that no two of a color share a moving body. Jones and
// Plassmann (1993, "A parallel graph coloring heuristic"): a manifold whose hashed key is the lowest among the
// uncolored ones of both its bodies takes the lowest color that both still have. That is the greedy coloring in order of
// the hash, whatever runs when; an order by index would wait along rows of neighbours. Twin: color_manifolds().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_RANGES) readonly buffer Ranges { uvec4 ranges[]; };
layout(std430, binding = BIND_PAIRS) coherent buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) coherent buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_COLORS) writeonly buffer Colors { uint color_starts[]; };
layout(std430, binding = BIND_ORDER) coherent buffer Order { SphereOrdered order[]; };

shared uint lowest[SPHERE_MAX_BODIES], used_low[SPHERE_MAX_BODIES], used_high[SPHERE_MAX_BODIES];
shared uint members[SPHERE_COLORS * SPHERE_MAX_CONTACTS];  // by color and length: how many, then where the next one goes
shared uint color_members[SPHERE_COLORS], starts[SPHERE_COLORS];
shared uint left[2];  // uncolored manifolds, take turns
shared uint contact_count, row_count, row_top;

#define lowest_of(i) lowest[i]
#define used_low_of(i) used_low[i]
#define used_high_of(i) used_high[i]
#define members_of(k) members[k]
#define members_in(c) color_members[c]
#define start_of(c) starts[c]
#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/color.h"
#include "sphere/order.h"

// One invocation: where each color begins.
void place_colors(SphereWorld world, uint w, uint list, uint count) {
  uint sum = 0u, colors = 0u;
  for (uint c = 0u; c < SPHERE_COLORS; ++c) {
    starts[c] = sum;
    sum += members_in(c);
    if (members_in(c) > 0u) colors = c + 1u;
    color_starts[w * (SPHERE_COLORS + 1u) + c] = starts[c];
  }
  color_starts[w * (SPHERE_COLORS + 1u) + SPHERE_COLORS] = sum;
  progress[w].ordered = sum;
  progress[w].colors += colors;
  progress[w].contacts += contact_count;
  progress[w].rows = row_count / SPHERE_ROW_PARTS;
  if (progress[w].rows > world.rows.y) progress[w].overflow = SPHERE_ROW_OVERFLOW;
  put_last_in_order(world, list, count);
}

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint count = progress[w].pairs, list = 2u * world.pairs.x + progress[w].page * world.pairs.y;

  for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP) used_low[i] = used_high[i] = 0u;
  for (uint k = thread; k < SPHERE_COLORS * SPHERE_MAX_CONTACTS; k += SPHERE_WORLD_GROUP) members[k] = 0u;
  if (thread == 0u) contact_count = row_count = row_top = 0u;
  if (thread < 2u) left[thread] = 0u;
  barrier();
  uint own_contacts = 0u;
  for (uint p = thread; p < count; p += SPHERE_WORLD_GROUP) {
    uint n = contacts_to_solve(world, list + p);
    begin_color(list + p, n);
    own_contacts += n;
  }
  atomicAdd(contact_count, own_contacts);

  uint rounds = 0u;
  for (;; ++rounds) {
    uint turn = rounds & 1u;
    for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP) lowest[i] = 0xffffffffu;
    if (thread == 0u) left[turn ^ 1u] = 0u;
    barrier();
    for (uint p = thread; p < count; p += SPHERE_WORLD_GROUP)
      if (bid(world, list + p)) left[turn] = 1u;
    barrier();
    if (left[turn] == 0u) break;
    for (uint p = thread; p < count; p += SPHERE_WORLD_GROUP) {
      if (pairs[list + p].color != UNCOLORED) continue;
      uint color = take_color(world, list + p);
      if (color != UNCOLORED) count_member(world, list + p, color);
    }
    barrier();
  }

  memoryBarrierBuffer();  // colors and lengths are read behind the next barrier
  count_colors();
  barrier();
  if (thread == 0u) {
    place_colors(world, w, list, count);
    progress[w].coloring_rounds += rounds;
  }
  barrier();
  for (uint p = thread; p < count; p += SPHERE_WORLD_GROUP) put_in_order(world, list + p);
  memoryBarrierBuffer();
  barrier();
  for (uint o = thread; o < starts[LAST_COLOR]; o += SPHERE_WORLD_GROUP) join_block(world, o);
}
