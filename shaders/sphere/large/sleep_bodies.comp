// Rest of the bodies of a large world, an invocation each: noted, marked on their island, settled. Ends the step.
// Twin: update_sleep().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_WORK) coherent buffer Work { SphereWork work[]; };

#include "sphere/body.h"
#include "sphere/rest.h"
#include "sphere/no_jobs.h"
#include "sphere/large/large_world.h"
#include "sphere/large/island.h"

uniform uint stage;

void end_step() {
  status = no_jobs();
  large.extent = large.big = large.speed = large.turn = 0u;
  if (idle()) return;
  if (--progress[large_world].cuts_left == 0u) --progress[large_world].steps_left;
  if (progress[large_world].cold_steps != 0u) --progress[large_world].cold_steps;
  progress[large_world].forgets = 0u;
  ++progress[large_world].steps;
}

void main() {
  uint i = thread_index();
  SphereWorld world = worlds[large_world];
  if (stage == SLEEP_SETTLE && i == 0u) end_step();
  if (idle() || i >= world.bodies.y) return;
  uint body = world.bodies.x + i;
  if (stage == SLEEP_NOTE) {
    if (moves(body)) note_motion(body, large_world);
    label_of(i) = i;
    moved_lately_of(i) = 0u;
  } else if (stage == SLEEP_MARK) {
    uint root = root_of(i);
    atomicMin(label_of(i), root);
    if (moved_lately(body)) moved_lately_of(root) = 1u;
  } else {
    settle(body, world.bodies.x + label_of(i), moved_lately_of(label_of(i)) == 1u, large_world);
  }
}
