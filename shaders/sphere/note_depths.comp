// One group per world: finds the deepest contact at the beginning of the step, by its depth as a share of the diagonal of
// the smaller part. It replaces the worst contact of the world if that was less deep. Of equally deep contacts, that of
// the pair with the lowest bodies is named, so that the order of manifolds does not matter. Runs after prepare_rows and
// before solve, which moves the bodies. Twin: note_depths().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) readonly buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_FIELDS) readonly buffer Fields { vec2 fields[]; };
layout(std430, binding = BIND_CONTACTS) readonly buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_ORDER) readonly buffer Order { SphereOrdered order[]; };
layout(std430, binding = BIND_ROWS) buffer Rows { vec4 rows[]; };
layout(std430, binding = BIND_IMPULSES) buffer Impulses { vec2 impulses[]; };
layout(std430, binding = BIND_WORST) buffer Worst { SphereWorst worst[]; };

#include "shared/language.h"
#include "shared/rotation.h"
#include "sphere/contact_row.h"
#include "sphere/body.h"
#include "sphere/field.h"

struct Placed {
  Field field;
  mat3 rotation;
  vec3 position;
};

#include "shared/sphere/overlap.h"
#include "sphere/ordered.h"

shared uint deepest;  // bits of a share of the diagonal; shares are not negative, so that bits are ordered as they are
shared uint pair;     // lowest key of the manifolds that are as deep

const uint NO_PAIR = 0xffffffffu;

struct Depth {
  float relative;  // share of the diagonal
  uint key;        // both bodies, counted in the world
};

// m; of the smaller of two bodies of all worlds.
float diagonal_of(uint a, uint b) {
  float own = bodies[a].material.w;
  return b == SPHERE_GROUND ? own : min(own, bodies[b].material.w);
}

Placed placed(uint body) {
  return Placed(field_of(bodies[body].ids.x), rotation_of(states[body].orientation), states[body].position.xyz);
}

float overlap_of(SphereContact c, Members of, float depth) {
  Placed a = placed(of.a), b = placed(of.b);
  return overlap_at(a, b, a.position + a.rotation * c.anchor_a, b.position + b.rotation * c.anchor_b, depth);
}

// Depths up to `limit` (share of the diagonal) need not be exact.
Depth depth_of(SphereWorld world, SphereOrdered m, float limit) {
  Members of = bodies_of(world, m.bodies);
  float deepest = 0.0;
  uint count = count_of(m.kind), stride = stride_of(m.kind);
  for (uint k = 0u; k < count; ++k) {
    float depth = -found_gap_at(SPHERE_ROW_PARTS * (world.rows.x + k * stride) + m.row, stride);
    if (of.b != SPHERE_GROUND && depth > limit * diagonal_of(of.a, of.b))
      depth = overlap_of(contacts[SPHERE_MAX_CONTACTS * (world.pairs.x + m.slot) + k], of, depth);
    deepest = max(deepest, depth);
  }
  uint a = of.a - world.bodies.x, b = of.b == SPHERE_GROUND ? 0xffffu : of.b - world.bodies.x;
  return Depth(deepest / diagonal_of(of.a, of.b), a << 16 | b);
}

void main() {
  uint w = running[gl_WorkGroupID.x];
  SphereWorld world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  if (gl_LocalInvocationIndex == 0u) {
    deepest = 0u;
    pair = NO_PAIR;
  }
  barrier();
  Depth own = Depth(0.0, NO_PAIR);
  for (uint o = gl_LocalInvocationIndex; o < progress[w].ordered; o += SPHERE_WORLD_GROUP) {
    Depth next = depth_of(world, order[world.pairs.x + o], worst[w].relative);
    if (next.relative > own.relative || next.relative == own.relative && next.key < own.key) own = next;
  }
  bool overlaps = own.relative > 0.0;
  if (overlaps) atomicMax(deepest, floatBitsToUint(own.relative));  // not of -0, whose bits are the largest
  barrier();
  bool is_deepest = overlaps && floatBitsToUint(own.relative) == deepest;
  if (is_deepest) atomicMin(pair, own.key);
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  worst[w].ago += progress[w].time_step;
  if (uintBitsToFloat(deepest) <= worst[w].relative) return;
  float relative = uintBitsToFloat(deepest);
  uint a = pair >> 16, b = pair & 0xffffu;
  bool on_ground = b == 0xffffu;
  float depth = relative * diagonal_of(world.bodies.x + a, on_ground ? SPHERE_GROUND : world.bodies.x + b);
  worst[w] = SphereWorst(a, on_ground ? SPHERE_GROUND : b, depth, relative, 0.0, worst[w].unresolved, 0u,
                         0u);
}
