// One group a world: colors for the manifolds to solve, so that no two of a color share a moving body. A manifold keeps
// the color that it had in the last step; of two that now share a body and have the same one, both lose it. Those
// without a color get one by Jones and Plassmann (1993, "A parallel graph coloring heuristic"): a manifold whose key is
// the lowest among the uncolored ones of both its bodies takes the lowest color that both still have. That is the
// greedy coloring in order of the keys, whatever runs when; an order by index would wait along rows of neighbours. All
// are colored anew where that needs more colors than the last time, because each color is a barrier in every sweep, and
// in the next step where neighbours in the order need too different numbers of visits. Twin: color_manifolds().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) coherent buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_RANGES) readonly buffer Ranges { uvec4 ranges[]; };
layout(std430, binding = BIND_PAIRS) coherent buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) coherent buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_COLORS) writeonly buffer Colors { uint color_starts[]; };
layout(std430, binding = BIND_ORDER) coherent buffer Order { SphereOrdered order[]; };

shared uint lowest[SPHERE_MAX_BODIES], used_low[SPHERE_MAX_BODIES], used_high[SPHERE_MAX_BODIES];
shared uint members[SPHERE_COLORS * (2 * SPHERE_MAX_CONTACTS + 1)];  // by color and visits: how many, then where the next one goes
shared uint color_members[SPHERE_COLORS], starts[SPHERE_COLORS];
shared uint twice_low[SPHERE_MAX_BODIES], twice_high[SPHERE_MAX_BODIES];  // colors that two manifolds of a body had
shared uint uncolored, some_twice, highest_color;
shared uint visits, longest_visits;  // of contacts: of all manifolds, and of the longest of each block of neighbours
shared uint left[2];  // a manifold is uncolored; take turns
shared uint contact_count, row_top;
shared uint some_struck;

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
#include "sphere/contact_gap.h"
#include "sphere/plan.h"

const uint COLORED_ANEW = 0x80000000u;

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
  put_last_in_order(world, list, count);
}

#define FOR_OWN(i, count) for (uint i = gl_LocalInvocationIndex; i < (count); i += SPHERE_WORLD_GROUP)
// Places in the list of pairs of manifolds without a color lie where their order will.
#define uncolored_at(k) order[world.pairs.x + (k)].row

void add_uncolored(SphereWorld world, uint p) {
  pairs[p].color = UNCOLORED;
  uncolored_at(atomicAdd(uncolored, 1u)) = p;
}

// Returns whether the bodies of a pair hit each other within `seconds`, at the speed of impacts that bounce. Twin:
// strikes() in contact_gap.hpp.
bool pair_strikes(SphereWorld world, SpherePair pair, float seconds) {
  float least = seconds * settings.restitution_speed;
  uint slot = world.pairs.x + pair.slot, count = manifolds[slot].state.x;
  for (uint k = 0u; k < count; ++k) {
    SphereContact c = contacts[SPHERE_MAX_CONTACTS * slot + k];
    if (!(c.force.x > 0.0) && strikes(c, pair, seconds, least, least)) return true;
  }
  return false;
}

// Wakes sleeping bodies that are hit in this step, and their islands. Twin: wake_struck().
#define island_is_struck(i) lowest[i]  // coloring writes it only behind two more barriers
// Returns the index of the island of a body in its world. A body that came from the host has no label yet.
uint island_of(SphereWorld world, uint body) {
  uint label = states[body].flags.y;
  return (label == 0u ? body : label - 1u) - world.bodies.x;
}
void wake_struck(SphereWorld world, uint w, uint list, uint count) {
  float seconds = progress[w].time_step + plan_of(w).sub_step;  // the last sweeps look ahead by a sub-step
  FOR_OWN(i, world.bodies.y) island_is_struck(i) = 0u;
  if (gl_LocalInvocationIndex == 0u) some_struck = 0u;
  barrier();
  FOR_OWN(p, count) {
    SpherePair pair = pairs[list + p];
    if (pair.b == SPHERE_GROUND || sleeps(pair.a) == sleeps(pair.b) || !pair_strikes(world, pair, seconds)) continue;
    island_is_struck(island_of(world, sleeps(pair.a) ? pair.a : pair.b)) = 1u;
    some_struck = 1u;
  }
  barrier();
  if (some_struck == 0u) return;
  FOR_OWN(i, world.bodies.y) {
    uint body = world.bodies.x + i;
    if (!sleeps(body) || island_is_struck(island_of(world, body)) == 0u) continue;
    states[body].flags.x &= ~SPHERE_ASLEEP;
    states[body].still_position.w = progress[w].time_step;  // it does not fall
  }
  memoryBarrierBuffer();  // the barrier is that of keep_colors()
}

void claim(uint i, uvec2 bit) {
  uvec2 both = uvec2(atomicOr(used_low[i], bit.x), atomicOr(used_high[i], bit.y)) & bit;
  if (both == uvec2(0u)) return;
  atomicOr(twice_low[i], both.x);
  atomicOr(twice_high[i], both.y);
  some_twice = 1u;
}

void give_back(uint i, uvec2 bit) {
  atomicAnd(used_low[i], ~bit.x);
  atomicAnd(used_high[i], ~bit.y);
}

bool is_twice(uint i, uvec2 bit) { return (uvec2(twice_low[i], twice_high[i]) & bit) != uvec2(0u); }

// Each manifold's color of the last step is claimed on its bodies, unless all are to be colored anew.
void keep_colors(SphereWorld world, uint list, uint count, bool anew) {
  FOR_OWN(i, world.bodies.y) used_low[i] = used_high[i] = twice_low[i] = twice_high[i] = 0u;
  if (gl_LocalInvocationIndex == 0u) uncolored = some_twice = highest_color = visits = contact_count = 0u;
  barrier();
  uint own_contacts = 0u, own_visits = 0u;
  FOR_OWN(p, count) {
    SpherePair pair = pairs[list + p];
    uint n = contacts_to_solve(world, list + p);
    own_contacts += n;
    if (n == 0u) {
      if (pair.color != NOT_SOLVED) pairs[list + p].color = NOT_SOLVED;
      continue;
    }
    own_visits += visits_of(world, pair);
    if (anew || pair.color >= LAST_COLOR) {
      add_uncolored(world, list + p);
      continue;
    }
    uvec2 bit = color_bit(pair.color);
    if (moves(pair.a)) claim(pair.a - world.bodies.x, bit);
    if (pair.b != SPHERE_GROUND && moves(pair.b)) claim(pair.b - world.bodies.x, bit);
  }
  atomicAdd(contact_count, own_contacts);
  atomicAdd(visits, own_visits);
  memoryBarrierBuffer();
  barrier();
}

// Bodies that were not moved by a step may have two manifolds of a color when they are. Known behind the next barrier.
void drop_colors_that_are_twice(SphereWorld world, uint list, uint count) {
  FOR_OWN(p, count) {
    SpherePair pair = pairs[list + p];
    if (pair.color >= LAST_COLOR) continue;
    uvec2 bit = color_bit(pair.color);
    bool a_moves = moves(pair.a), b_moves = pair.b != SPHERE_GROUND && moves(pair.b);
    uint a = pair.a - world.bodies.x, b = b_moves ? pair.b - world.bodies.x : a;
    if (!(a_moves && is_twice(a, bit) || b_moves && is_twice(b, bit))) continue;
    if (a_moves) give_back(a, bit);
    if (b_moves) give_back(b, bit);
    add_uncolored(world, list + p);
  }
  memoryBarrierBuffer();
}

// Returns in how many rounds.
uint color_uncolored(SphereWorld world) {
  uint rounds = 0u;
  if (gl_LocalInvocationIndex < 2u) left[gl_LocalInvocationIndex] = 0u;
  for (;; ++rounds) {
    uint turn = rounds & 1u;
    FOR_OWN(i, world.bodies.y) lowest[i] = 0xffffffffu;
    if (gl_LocalInvocationIndex == 0u) left[turn ^ 1u] = 0u;
    barrier();
    FOR_OWN(k, uncolored) if (bid(world, uncolored_at(k))) left[turn] = 1u;
    barrier();
    if (left[turn] == 0u) return rounds;
    FOR_OWN(k, uncolored) {
      uint p = uncolored_at(k);
      if (pairs[p].color != UNCOLORED) continue;
      uint color = take_color(world, p);
      if (color != UNCOLORED) atomicMax(highest_color, color);
    }
    barrier();
  }
}

// Returns in how many rounds; what is written is read behind the next barrier.
uint color_all(SphereWorld world, uint w, uint list, uint count) {
  uint rounds = 0u;
  for (uint attempt = 0u; attempt < 2u; ++attempt) {
    bool anew = attempt > 0u || progress[w].base_colors == 0u;
    keep_colors(world, list, count, anew);
    if (some_twice != 0u) drop_colors_that_are_twice(world, list, count);
    rounds += color_uncolored(world);
    bool good = highest_color < progress[w].base_colors;
    if (!anew && good) return rounds;
    if (anew) break;
    memoryBarrierBuffer();
    barrier();  // all have seen what the next attempt clears
  }
  return rounds | COLORED_ANEW;
}

// Neighbours wait until the longest of them has had its visits of contacts. Where that takes an eighth longer than when
// all were colored anew, the next step does so again. A step that is repeated for want of rows must find the colors of
// this attempt: its repetition judges them.
void judge_colors(uint w, bool anew) {
  uint waste = (longest_visits << 10u) / max(visits, 1u);
  if (anew) {
    progress[w].base_colors = highest_color + 1u;
    progress[w].base_waste = waste;
    ++progress[w].colorings;
  } else if (progress[w].overflow == 0u && 8u * waste > 9u * progress[w].base_waste) {
    progress[w].base_colors = 0u;
  }
}

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  uint count = progress[w].pairs, list = 2u * world.pairs.x + progress[w].page * world.pairs.y;

  FOR_OWN(k, SPHERE_COLORS * VISIT_KINDS) members[k] = 0u;
  if (thread == 0u) row_top = longest_visits = 0u;
  wake_struck(world, w, list, count);
  uint rounds = color_all(world, w, list, count);
  memoryBarrierBuffer();
  barrier();
  FOR_OWN(p, count) if (pairs[list + p].color <= LAST_COLOR) count_member(world, list + p, pairs[list + p].color);
  barrier();
  count_colors();
  barrier();
  if (thread == 0u) {
    place_colors(world, w, list, count);
    progress[w].coloring_rounds += rounds & ~COLORED_ANEW;
  }
  barrier();
  FOR_OWN(p, count) put_in_order(world, list + p);
  memoryBarrierBuffer();
  barrier();
  uint ordered = starts[LAST_COLOR] + members_in(LAST_COLOR);
  FOR_OWN(o, ordered) note_length(world, o);
  memoryBarrierBuffer();
  barrier();
  FOR_OWN(o, ordered) take_rows(world, o);
  memoryBarrierBuffer();
  barrier();
  FOR_OWN(o, ordered) join_block(world, o);
  if (thread != 0u) return;
  progress[w].rows = row_top / SPHERE_ROW_PARTS;
  if (progress[w].rows > world.rows.y) progress[w].overflow = SPHERE_ROW_OVERFLOW;
  judge_colors(w, (rounds & COLORED_ANEW) != 0u);
}
