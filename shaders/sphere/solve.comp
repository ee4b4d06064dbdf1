// One group a world: the whole of a step's solve, sub-stepped soft contacts with relaxation (Catto 2024, "Solver2D"),
// Gauss-Seidel over the colors of manifolds with the velocities in shared memory. Twin: solve().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_TENSORS) readonly buffer Tensors { SphereTensor tensors[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_COLORS) readonly buffer Colors { uint color_starts[]; };
layout(std430, binding = BIND_ORDER) buffer Order { SphereOrdered order[]; };
layout(std430, binding = BIND_ROWS) restrict buffer Rows { vec4 rows[]; };
layout(std430, binding = BIND_IMPULSES) restrict buffer Impulses { vec2 impulses[]; };
layout(std430, binding = BIND_WORST) buffer Worst { SphereWorst worst[]; };

// Of bodies, and behind them of the ground.
shared vec4 velocity[SPHERE_MAX_BODIES + 1];  // w: inverse mass, 0 = nothing moves it in this step
shared vec4 spin[SPHERE_MAX_BODIES + 1];      // w: 1 = a contact is near
shared vec4 moved[SPHERE_MAX_BODIES + 1];     // since contacts were found; w: speed when the sub-step began
shared vec4 turned[SPHERE_MAX_BODIES + 1];    // rotation vector, since then; w: 1 = a contact slips
shared uint starts[SPHERE_COLORS + 1];
shared uint any_bounce, any_impact;
shared uint some_unconverged[2];  // a contact is; take turns

#define velocity_of(i) velocity[i]
#define spin_of(i) spin[i]
#define moved_of(i) moved[i]
#define turned_of(i) turned[i]
#include "sphere/body.h"
#include "sphere/solve_body.h"
#include "sphere/solve_manifold.h"

uint ordered;

// The manifolds of color c that are this invocation's in every sweep: nobody else touches their rows. The last color
// is that of manifolds which share bodies: one invocation takes them in order.
uint own_first(uint c) {
  if (c < SPHERE_COLORS - 1u) return gl_LocalInvocationIndex;
  return gl_LocalInvocationIndex == 0u ? 0u : ordered;
}
uint own_step(uint c) { return c < SPHERE_COLORS - 1u ? SPHERE_WORLD_GROUP : 1u; }
#define FOR_OWN_MANIFOLDS(o)                                              \
  for (uint c = 0u, begin = 0u; begin < ordered; begin = starts[++c]) \
    for (uint o = begin + own_first(c); o < starts[c + 1u]; o += own_step(c))
#define FOR_OWN_BODIES(i) for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_WORLD_GROUP)

void begin_body(uint i) {
  uint body = world.bodies.x + i;
  bool moving = moves(body);
  velocity[i] = moving ? vec4(states[body].velocity.xyz, bodies[body].material.x) : vec4(0.0);
  spin[i] = moving ? vec4(states[body].spin.xyz, 0.0) : vec4(0.0);
  moved[i] = vec4(0.0);
  turned[i] = vec4(0.0);
}

// One sweep over all manifolds, color by color.
void sweep(uint kind) {
  Give give = firmly_now;
  if (kind == SWEEP_FIRST_PUSH || kind == SWEEP_PUSH) give = softly_now;
  for (uint c = 0u, begin = 0u; begin < ordered; ++c) {
    uint end = starts[c + 1u];
    for (uint o = begin + own_first(c); o < end; o += own_step(c)) solve_manifold(o, kind, give);
    begin = end;
    barrier();
  }
}

// Whether a contact of any manifold is not solved yet after a sweep.
bool any_unconverged(uint sweeps) {
  uint turn = sweeps & 1u;
  if (unconverged) some_unconverged[turn] = 1u;
  if (gl_LocalInvocationIndex == 0u) some_unconverged[turn ^ 1u] = 0u;
  barrier();
  return some_unconverged[turn] != 0u;
}

void begin_sub_step(uint w, int k) {
  take_sub_step_of(w, uint(k));
  tolerance = any_impact != 0u ? world.tolerance.y : world.tolerance.x;
  FOR_OWN_BODIES(i) integrate_velocity(i, plan.sub_step);
  barrier();
}

void move_bodies() {
  FOR_OWN_MANIFOLDS(o) note_sliding(o);
  barrier();
  FOR_OWN_BODIES(i) integrate_position(i, plan.sub_step);
  barrier();
}

// Whether Newton's restitution has something to do.
bool any_bounces() {
  if (gl_LocalInvocationIndex == 0u) any_bounce = 0u;
  barrier();
  FOR_OWN_MANIFOLDS(o) if (bounces(o)) any_bounce = 1u;
  barrier();
  return any_bounce != 0u;
}

// All sub-steps. The sweeps of all kinds run in this one loop, because compilers copy `sweep` to each place that calls it.
void solve_sub_steps(uint w) {
  uint kind = SWEEP_WARM_START, sweeps = 0u;
  int k = 0, done = 0;  // sub-steps; sweeps since the warm start, since bodies moved, or since the first one that bounces
  for (;;) {
    if (kind == SWEEP_WARM_START) begin_sub_step(w, k);
    unconverged = false;
    sweep(kind);
    if (kind == SWEEP_WARM_START) {
      kind = SWEEP_FIRST_PUSH;
      done = 0;
      continue;
    }
    ++done;
    if (kind == SWEEP_BOUNCE) {
      if (done == int(SPHERE_BOUNCE_SWEEPS)) return;
      continue;
    }
    // Without manifolds no sweep waits, and one could ask while another still reads the last answer.
    bool pushes = kind == SWEEP_FIRST_PUSH || kind == SWEEP_PUSH, impact = ordered > 0u && any_unconverged(sweeps++);
    if (done < (pushes ? plan.sweeps : plan.relaxing_sweeps) ||
        impact && done < int(any_impact != 0u ? world.rows.z : world.rows.w)) {
      kind = pushes ? SWEEP_PUSH : SWEEP_RELAX;
      continue;
    }
    bool is_unresolved = pushes && impact && any_impact != 0u && world.rows.z > 0u;
    if (is_unresolved && gl_LocalInvocationIndex == 0u) ++worst[w].unresolved;
    done = 0;
    if (pushes) {
      move_bodies();
      kind = SWEEP_FIRST_RELAX;
    } else if (++k < plan.sub_steps) {
      kind = SWEEP_WARM_START;
    } else {
      if (!any_bounces()) return;
      kind = SWEEP_BOUNCE;
    }
  }
}

void main() {
  uint w = running[gl_WorkGroupID.x];
  world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  ordered = progress[w].ordered;
  take_sub_step_of(w, 0u);
  for (uint c = gl_LocalInvocationIndex; c <= SPHERE_COLORS; c += SPHERE_WORLD_GROUP)
    starts[c] = color_starts[w * (SPHERE_COLORS + 1u) + c];
  if (gl_LocalInvocationIndex < 2u) some_unconverged[gl_LocalInvocationIndex] = 0u;
  if (gl_LocalInvocationIndex == 0u) any_impact = 0u;
  FOR_OWN_BODIES(i) begin_body(i);
  if (gl_LocalInvocationIndex == 0u) {
    const uint i = SPHERE_GROUND_BODY;
    velocity[i] = spin[i] = moved[i] = turned[i] = vec4(0.0);
  }
  barrier();
  FOR_OWN_MANIFOLDS(o) if (begin_manifold(o)) any_impact = 1u;
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    uint struck = any_impact;
    any_impact |= progress[w].struck;  // what is left of the last step's impact is no force yet
    progress[w].struck = world.tolerance.z > 0.0 ? struck : 0u;
  }
  barrier();
  solve_sub_steps(w);
  FOR_OWN_MANIFOLDS(o) keep_forces(o);
  uint falling = 0u;
  FOR_OWN_BODIES(i) falling += uint(keep_body(i));
  atomicAdd(progress[w].free_steps, falling);
}
