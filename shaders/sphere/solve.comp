// One group a world: the whole of a step's solve, sub-stepped soft contacts with relaxation (Catto 2024, "Solver2D"),
// Gauss-Seidel over the colors of manifolds with the velocities in shared memory. Twin: solve().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_TENSORS) readonly buffer Tensors { SphereTensor tensors[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_COLORS) readonly buffer Colors { uint color_starts[]; };
layout(std430, binding = BIND_ORDER) readonly buffer Order { uint order[]; };

shared vec4 velocity[SPHERE_MAX_BODIES];  // w: inverse mass, 0 = nothing moves it in this step
shared vec4 spin[SPHERE_MAX_BODIES];      // w: 1 = a contact is near
shared vec4 moved[SPHERE_MAX_BODIES];     // since contacts were found
shared vec4 turned[SPHERE_MAX_BODIES];    // rotation vector, since then
shared uint starts[SPHERE_COLORS + 1];
shared uint any_bounce;

SphereWorld world;
uint ordered, list;
vec4 softness;  // of contacts: rate (Hz), damping ratio, slop (d), sub-steps in place of one

float sub_step() { return settings.time_step / (float(settings.sub_steps) * softness.w); }

#include "sphere/body.h"

// A body as one manifold sees it.
struct Side {
  vec3 v, w, moved, turned, position;
  vec4 orientation;
  float inverse_mass;
  vec3 tensor, tensor_mixed;
};

Side side_of(uint body) {
  Side s = Side(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0), 0.0, vec3(0.0),
                vec3(0.0));
  if (body == SPHERE_GROUND) return s;
  uint i = body - world.bodies.x;
  s.v = velocity[i].xyz;
  s.w = spin[i].xyz;
  s.moved = moved[i].xyz;
  s.turned = turned[i].xyz;
  s.position = states[body].position.xyz;
  s.orientation = tensors[body].orientation;
  s.inverse_mass = velocity[i].w;
  if (s.inverse_mass > 0.0) {
    s.tensor = tensors[body].diagonal.xyz;
    s.tensor_mixed = tensors[body].mixed.xyz;
  }
  return s;
}

void keep_side(uint body, Side s) {
  if (s.inverse_mass == 0.0) return;
  uint i = body - world.bodies.x;
  velocity[i].xyz = s.v;
  spin[i].xyz = s.w;
}

#include "sphere/contact_place.h"
#include "sphere/contact_row.h"

SpherePair pair_at(uint o) { return pairs[list + order[world.pairs.x + o]]; }

// The manifolds of color c that are this invocation's in every sweep: nobody else touches their rows. The last color is
// that of manifolds which share bodies: one invocation takes them in order.
uint first_of(uint c) {
  return c < SPHERE_COLORS - 1u ? starts[c] + gl_LocalInvocationIndex : gl_LocalInvocationIndex == 0u ? starts[c] : ordered;
}
uint stride_of(uint c) { return c < SPHERE_COLORS - 1u ? SPHERE_GROUP : 1u; }
#define FOR_OWN_MANIFOLDS(o)                                      \
  for (uint c = 0u; c < SPHERE_COLORS && starts[c] < ordered; ++c) \
    for (uint o = first_of(c); o < starts[c + 1u]; o += stride_of(c))

void begin_bodies() {
  for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_GROUP) {
    uint body = world.bodies.x + i;
    bool moving = moves(body);
    velocity[i] = moving ? vec4(states[body].velocity.xyz, bodies[body].material.x) : vec4(0.0);
    spin[i] = moving ? vec4(states[body].spin.xyz, 0.0) : vec4(0.0);
    moved[i] = vec4(0.0);
    turned[i] = vec4(0.0);
  }
}

#define FOR_CONTACTS(at, slot)                                                                           \
  for (uint i = 0u, n = manifolds[world.pairs.x + slot].state.x, at = first_contact(world, slot); i < n; \
       ++i, at = next_contact(world, at))

void prepare_contacts() {
  FOR_OWN_MANIFOLDS(o) {
    SpherePair pair = pair_at(o);
    Side a = side_of(pair.a), b = side_of(pair.b);
    FOR_CONTACTS(at, pair.slot) prepare(at, a, b);
    manifolds[world.pairs.x + pair.slot].state.y = 0u;
    spin[pair.a - world.bodies.x].w = 1.0;  // all that come here write the same
    if (pair.b != SPHERE_GROUND) spin[pair.b - world.bodies.x].w = 1.0;
  }
}

void integrate_velocities(float h) {
  for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_GROUP)
    if (velocity[i].w > 0.0) {
      uint body = world.bodies.x + i;
      velocity[i].xyz += h * world.gravity.xyz;
      spin[i].xyz = gyrated(spin[i].xyz, states[body].orientation, bodies[body], h);
    }
  barrier();
}

void integrate_positions(float h) {
  for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_GROUP)
    if (velocity[i].w > 0.0) {
      moved[i].xyz += h * velocity[i].xyz;
      if (spin[i].w == 0.0) moved[i].xyz -= 0.5 * h * h * world.gravity.xyz;  // touched by nothing: exactly the parabola
      turned[i].xyz += h * spin[i].xyz;
      uint body = world.bodies.x + i;
      states[body].orientation = normalize(quat_multiply(quat_of_turn(h * spin[i].xyz), states[body].orientation));
    }
  barrier();
}

const uint WARM_START = 0u, PUSH = 1u, RELAX = 2u, BOUNCE = 3u;

// One sweep over all manifolds, color by color.
void sweep(uint kind, float h) {
  for (uint c = 0u; c < SPHERE_COLORS && starts[c] < ordered; ++c) {
    for (uint o = first_of(c); o < starts[c + 1u]; o += stride_of(c)) {
      SpherePair pair = pair_at(o);
      if (kind == BOUNCE && manifolds[world.pairs.x + pair.slot].state.y == 0u) continue;
      Side a = side_of(pair.a), b = side_of(pair.b);
      if (kind == WARM_START) {
        FOR_CONTACTS(at, pair.slot) warm_start(at, a, b);
      } else if (kind == BOUNCE) {
        FOR_CONTACTS(at, pair.slot) bounce(at, restitution_of(pair), a, b);
      } else {
        FOR_CONTACTS(at, pair.slot) solve_normal(at, h, kind == PUSH, a, b);
        float friction = friction_of(pair);
        FOR_CONTACTS(at, pair.slot) solve_friction(at, friction, a, b);
      }
      keep_side(pair.a, a);
      if (pair.b != SPHERE_GROUND) keep_side(pair.b, b);
    }
    barrier();
  }
}

// Newton's restitution, some sweeps of it: a face that strikes flat shares its blow among many contacts.
void restitute() {
  if (gl_LocalInvocationIndex == 0u) any_bounce = 0u;
  barrier();
  FOR_OWN_MANIFOLDS(o) {
    SpherePair pair = pair_at(o);
    if (restitution_of(pair) == 0.0) continue;
    Side a = side_of(pair.a), b = side_of(pair.b);
    FOR_CONTACTS(at, pair.slot) {
      Row row = row_of(contacts[at], a, b);
      if (row.impulse.w == 0.0 || !struck(row, a, b)) continue;
      manifolds[world.pairs.x + pair.slot].state.y = 1u;
      any_bounce = 1u;
    }
  }
  barrier();
  if (any_bounce == 0u) return;
  for (uint k = 0u; k < BOUNCE_SWEEPS; ++k) sweep(BOUNCE, 0.0);
}

void keep_forces() {
  FOR_OWN_MANIFOLDS(o) {
    SpherePair pair = pair_at(o);
    bool bounced = manifolds[world.pairs.x + pair.slot].state.y == 1u;
    Side a = side_of(pair.a), b = side_of(pair.b);
    uint presses = 0u;
    FOR_CONTACTS(at, pair.slot) if (keep_force(at, bounced, a, b)) presses = 1u;
    manifolds[world.pairs.x + pair.slot].state.y = presses;
  }
}

void keep_bodies() {
  uint falling = 0u;
  for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_GROUP)
    if (velocity[i].w > 0.0) {
      uint body = world.bodies.x + i;
      states[body].position.xyz += moved[i].xyz;
      states[body].velocity.xyz = velocity[i].xyz;
      states[body].spin.xyz = spin[i].xyz;
      if (spin[i].w == 0.0) ++falling;
    }
  atomicAdd(progress[running[gl_WorkGroupID.x]].free_steps, falling);
}

void main() {
  uint w = running[gl_WorkGroupID.x];
  world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  ordered = progress[w].ordered;
  softness = progress[w].pressed != 0u ? settings.stiff : settings.soft;
  list = 2u * world.pairs.x + progress[w].page * world.pairs.y;
  for (uint c = gl_LocalInvocationIndex; c <= SPHERE_COLORS; c += SPHERE_GROUP)
    starts[c] = color_starts[w * (SPHERE_COLORS + 1u) + c];
  begin_bodies();
  barrier();
  prepare_contacts();
  barrier();
  float h = sub_step();
  for (uint k = 0u; k < settings.sub_steps * uint(softness.w); ++k) {
    integrate_velocities(h);
    sweep(WARM_START, h);
    for (uint i = 0u; i < settings.sweeps; ++i) sweep(PUSH, h);
    integrate_positions(h);
    for (uint i = 0u; i < settings.sweeps; ++i) sweep(RELAX, h);
  }
  restitute();
  keep_forces();
  keep_bodies();
}
