// Begins a step of a large world, an invocation a body: how fast the fastest is when a whole step begins, and with one
// invocation, when all are known, how long the step is. Twin: cuts_of_fast().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };

#include "sphere/body.h"
#include "shared/language.h"
#include "shared/sphere/cut.h"
#include "sphere/speed.h"
#include "sphere/large/large_world.h"

uniform uint stage;  // CUT_MEASURE, CUT_SET

void main() {
  uint i = thread_index();
  if (stage == CUT_SET && i != 0u) return;  // it changes what the others would ask for
  SphereWorld world = worlds[large_world];
  bool awake = progress[large_world].steps_left != 0u && progress[large_world].overflow == 0u;
  if (!awake || progress[large_world].cuts_left != 0u) {
    if (i == 0u) large.awake = uint(awake);
    return;
  }
  if (stage == CUT_MEASURE) {
    if (i >= world.bodies.y || !moves(world.bodies.x + i)) return;
    vec2 speeds = speeds_of(world.bodies.x + i);
    atomicMax(large.speed, floatBitsToUint(speeds.x));
    atomicMax(large.turn, floatBitsToUint(speeds.y));
  } else if (i == 0u) {
    large.awake = 1u;
    uint cuts = cuts_of(vec2(uintBitsToFloat(large.speed), uintBitsToFloat(large.turn)), world.ground.w);
    progress[large_world].time_step = settings.time_step / float(cuts);
    progress[large_world].cuts_left = cuts;
  }
}
