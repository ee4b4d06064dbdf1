// What the solve of a large world does with its bodies, an invocation each. Velocities are those of the states, in place.
// Twin: solve().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_MOTIONS) buffer Motions { SphereMotion motions[]; };

uniform uint stage;

#define velocity_of(i) states[world.bodies.x + (i)].velocity
#define spin_of(i) states[world.bodies.x + (i)].spin
#define moved_of(i) motions[i].moved
#define turned_of(i) motions[i].turned
#include "sphere/body.h"
#include "sphere/solve_body.h"
#include "sphere/large/large_world.h"

// What does not move keeps its velocity, and is known by an inverse mass of 0.
void begin_body(uint i) {
  bool moving = moves(world.bodies.x + i);
  velocity_of(i).w = moving ? bodies[world.bodies.x + i].material.x : 0.0;
  spin_of(i).w = 0.0;
  motions[i] = SphereMotion(vec4(0.0), vec4(0.0));
}

void main() {
  uint i = thread_index();
  world = worlds[large_world];
  if (idle() || i >= world.bodies.y) return;
  take_sub_step_of(large_world, 0u);
  if (stage == BODIES_BEGIN)
    begin_body(i);
  else if (stage == BODIES_VELOCITIES)
    integrate_velocity(i, plan.sub_step);
  else if (stage == BODIES_POSITIONS)
    integrate_position(i, plan.sub_step);
  else if (keep_body(i))
    atomicAdd(progress[large_world].free_steps, 1u);
}
