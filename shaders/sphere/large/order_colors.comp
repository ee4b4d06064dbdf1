// One group: the rounds of coloring that had no dispatches of their own, then where each color begins.
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_PAIRS) coherent buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) readonly buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_COLORS) writeonly buffer Colors { uint color_starts[]; };
layout(std430, binding = BIND_ORDER) buffer Order { SphereOrdered order[]; };
layout(std430, binding = BIND_LARGE) coherent buffer Large { SphereLarge large; };
layout(std430, binding = BIND_WORK) coherent buffer Work { SphereWork work[]; };

uniform uint coloring_round;   // the first that had none
uniform uint spread_colors;    // that have dispatches of their own, whether or not they are wide

shared uint left;

#define lowest_of(i) work[i].lowest[0]
#define used_low_of(i) work[i].used_low
#define used_high_of(i) work[i].used_high
#define members_of(k) large.members[k]
#define members_in(c) large.members_in[c]
#define start_of(c) large.starts[c]
#define row_count large.row_count
#define row_top large.row_top
#include "sphere/body.h"
#include "sphere/color.h"
#include "sphere/order.h"
#include "sphere/large/large_world.h"

void rendezvous() {
  memoryBarrierBuffer();
  barrier();
}

void color_what_is_left(SphereWorld world, uint count) {
  for (;;) {
    for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_GROUP) work[i].lowest[0] = 0xffffffffu;
    if (gl_LocalInvocationIndex == 0u) left = 0u;
    rendezvous();
    for (uint p = gl_LocalInvocationIndex; p < count; p += SPHERE_GROUP)
      if (bid(world, large.list + p)) left = 1u;
    rendezvous();
    if (left == 0u) return;
    if (gl_LocalInvocationIndex == 0u) atomicAdd(progress[large_world].coloring_rounds, 1u);
    for (uint p = gl_LocalInvocationIndex; p < count; p += SPHERE_GROUP) {
      if (pairs[large.list + p].color != UNCOLORED) continue;
      uint color = take_color(world, large.list + p);
      if (color != UNCOLORED) count_member(world, large.list + p, color);
    }
    rendezvous();
  }
}

void main() {
  SphereWorld world = worlds[large_world];
  if (idle()) return;
  uint count = progress[large_world].pairs;
  if (large.round_groups[coloring_round].x != 0u) color_what_is_left(world, count);
  if (gl_LocalInvocationIndex == 0u) row_count = row_top = 0u;
  rendezvous();
  count_colors();
  rendezvous();
  if (gl_LocalInvocationIndex != 0u) return;
  uint sum = 0u, colors = 0u, wide = 0u;
  for (uint c = 0u; c < SPHERE_COLORS; ++c) {
    uint members = members_in(c);
    color_starts[large_world * (SPHERE_COLORS + 1u) + c] = large.starts[c] = sum;
    if (members > 0u) colors = c + 1u;
    if (members > SPHERE_GROUP) wide = c + 1u;
    sum += members;
  }
  color_starts[large_world * (SPHERE_COLORS + 1u) + SPHERE_COLORS] = sum;
  progress[large_world].ordered = sum;
  progress[large_world].colors += colors;
  progress[large_world].rows = row_count / SPHERE_ROW_PARTS;
  if (progress[large_world].rows > world.rows.y) progress[large_world].overflow = SPHERE_ROW_OVERFLOW;
  put_last_in_order(world, large.list, count);
  large.manifold_groups = uvec4(folded_groups((sum + SPHERE_GROUP - 1u) / SPHERE_GROUP), 0u);
  // Behind the last color that is wider than a group one group is as fast as many, and needs no dispatch for each.
  uint narrow = min(wide, spread_colors);
  for (uint c = 0u; c < narrow; ++c)
    large.color_groups[c] = uvec4(folded_groups((members_in(c) + SPHERE_GROUP - 1u) / SPHERE_GROUP), 0u);
  large.narrow_color = narrow;
  large.rest_groups.x = colors > narrow ? 1u : 0u;
  progress[large_world].wide_colors = max(progress[large_world].wide_colors, wide + 1u);
}
