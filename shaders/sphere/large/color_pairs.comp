// Colors for the manifolds of a large world, an invocation a manifold; the rounds of color_manifolds.comp, two dispatches
// each. A round that leaves something is followed by another. Twin: color_manifolds().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_PAIRS) buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_ORDER) buffer Order { SphereOrdered order[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_WORK) buffer Work { SphereWork work[]; };

uniform uint stage, coloring_round;

#define lowest_of(i) work[i].lowest[coloring_round & 1u]
#define used_low_of(i) work[i].used_low
#define used_high_of(i) work[i].used_high
#define members_of(k) large.members[k]
#define members_in(c) large.members_in[c]
#define start_of(c) large.starts[c]
#define row_count large.row_count
#define row_top large.row_top
#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/color.h"
#include "sphere/order.h"
#include "sphere/large/large_world.h"

// The other rounds' lowest key of both bodies, for the next round.
void forget_lowest(SphereWorld world, SpherePair pair) {
  uint next = coloring_round & 1u ^ 1u;
  if (moves(pair.a)) work[pair.a - world.bodies.x].lowest[next] = 0xffffffffu;
  if (pair.b != SPHERE_GROUND && moves(pair.b)) work[pair.b - world.bodies.x].lowest[next] = 0xffffffffu;
}

void main() {
  SphereWorld world = worlds[large_world];
  uint p = large.list + thread_index();
  if (idle()) return;
  if (stage == COLOR_BID && thread_index() == 0u) atomicAdd(progress[large_world].coloring_rounds, 1u);
  if (thread_index() >= progress[large_world].pairs) return;
  if (stage == COLOR_BEGIN) {
    uint n = contacts_to_solve(world, p);
    begin_color(p, n);
    if (n == 0u) return;
    atomicAdd(progress[large_world].contacts, n);
    large.round_groups[0] = large.pair_groups;
  } else if (stage == COLOR_BID) {
    bid(world, p);
  } else if (stage == COLOR_TAKE) {
    if (pairs[p].color != UNCOLORED) return;
    uint color = take_color(world, p);
    if (color != UNCOLORED) {
      count_member(world, p, color);
      return;
    }
    forget_lowest(world, pairs[p]);
    large.round_groups[coloring_round + 1u] = large.pair_groups;  // all write the same
  } else if (stage == COLOR_ORDER) {
    put_in_order(world, p);
  } else if (thread_index() < large.starts[LAST_COLOR]) {
    join_block(world, thread_index());
  }
}
