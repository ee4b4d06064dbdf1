// One group a world, after its steps: which bodies have stayed near one pose and since when, which have left the bin,
// and how many move fast or are awake. The host reads the counts. A world whose steps are not done is not observed: of
// it the host learns how many are left. Twins: RestWatch, HeapCore::outside(), HeapCore::slow().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) readonly buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_ASKS) readonly buffer Asks { SphereAsk asks[]; };
layout(std430, binding = BIND_WATCHED) buffer Watched { SphereWatched watched[]; };
layout(std430, binding = BIND_SEEN) buffer Seen { SphereSeen seen[]; };

#include "sphere/body.h"
#include "sphere/watched.h"

shared uint outside, fast, awake, unrested;
shared uint moved[4];  // by SphereAsk.since

// NaN is outside.
bool is_outside(SphereState s, SphereAsk ask) {
  vec3 center = s.position.xyz + s.position_rest.xyz;
  bool inside = all(greaterThanEqual(center, ask.lower.xyz)) && all(lessThanEqual(center, ask.upper.xyz));
  return !(inside && dot(s.orientation, s.orientation) > 0.5);
}

bool is_still(uint body, SphereState s, SphereAsk ask) {
  vec3 shift = shift_from(watched[body].still.xyz, watched[body].still_rest.xyz, s);
  vec4 turned = quat_multiply(quat_conjugate(watched[body].still_orientation), s.orientation);
  float turn = 2.0 * atan(length(turned.xyz), abs(turned.w));
  return s.flags.w != 0u && length(shift) <= ask.lower.w * bodies[body].material.w && turn <= ask.upper.w;
}

// Faster than a part that falls.
bool is_fast(uint body, SphereState s, float gravity) {
  float size = bodies[body].material.w;
  return !(length(s.velocity.xyz) + 0.5 * size * length(s.spin.xyz) <= 0.25 * sqrt(gravity * size));
}

void watch(uint body, SphereAsk ask, float gravity) {
  SphereState s = states[body];
  if (is_outside(s, ask)) {
    states[body].flags.x = s.flags.x | SPHERE_OUTSIDE;
    atomicAdd(outside, 1u);
    return;
  }
  uint since = s.flags.w;
  if (!is_still(body, s, ask)) {
    watched[body].still = s.position;
    watched[body].still_rest = s.position_rest;
    watched[body].still_orientation = s.orientation;
    states[body].flags.w = since = ask.observation;
  }
  if (is_fast(body, s, gravity)) atomicAdd(fast, 1u);
  if ((s.flags.x & SPHERE_ASLEEP) == 0u) atomicAdd(awake, 1u);
  if (since > ask.rested) atomicAdd(unrested, 1u);
  for (uint k = 0u; k < 4u; ++k)
    if (since >= ask.since[k]) atomicAdd(moved[k], 1u);
}

// SphereSeen::left.
uint left_of(uint w) {
  uint whole = progress[w].steps_left, cuts = 1u;
  if (progress[w].time_step > 0.0) cuts = clamp(uint(settings.time_step / progress[w].time_step + 0.5), 1u, 64u);
  uint begun = progress[w].cuts_left;  // the rest of a whole step
  uint left = whole == 0u ? 0u : min((begun == 0u ? whole : whole - 1u) * cuts + begun, 0xffffffu);
  return left | cuts << 24 | (progress[w].overflow != 0u ? SPHERE_BLOCKED : 0u);
}

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  SphereWorld world = worlds[w];
  SphereAsk ask = asks[w];
  if (progress[w].steps_left != 0u || progress[w].overflow != 0u || ask.observation == 0u) {
    if (thread == 0u) seen[w].left = left_of(w);
    return;
  }
  if (thread == 0u) outside = fast = awake = unrested = 0u;
  if (thread < 4u) moved[thread] = 0u;
  barrier();
  float gravity = length(world.gravity.xyz);
  for (uint i = thread; i < world.bodies.y; i += SPHERE_WORLD_GROUP)
    if (is_watched(world.bodies.x + i)) watch(world.bodies.x + i, ask, gravity);
  barrier();
  if (thread != 0u) return;
  seen[w] = SphereSeen(left_of(w), ask.observation, outside, fast, awake, unrested, moved[0] | moved[1] << 16,
                       moved[2] | moved[3] << 16);
}
