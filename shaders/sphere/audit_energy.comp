// One group a world, after watch_rest: mechanical energy that bodies, groups of them that may have touched, or all of
// them together have gained since the last observation, and bodies that left faster than what was near them. The worst
// of each is kept until the host asks to begin anew. Ends an observation. Twin: EnergyAudit, with the same numbers.
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) readonly buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_ASKS) buffer Asks { SphereAsk asks[]; };
layout(std430, binding = BIND_WATCHED) buffer Watched { SphereWatched watched[]; };
layout(std430, binding = BIND_AUDITS) buffer Audits { SphereAudit audits[]; };

#include "sphere/body.h"
#include "sphere/watched.h"

const float EARTH = 9.81;          // m/s2: gravity where there is none, to have a unit
const float ALLOWED = 1e-3;        // share of kinetic energy that integration may gain
const float STIRS = 1e-4;          // m g d: change of energy from which a part has moved
const float SWIFT = 1e-6;          // m g d: kinetic energy from which a part has moved
const float TOUCHING = 0.02;       // of the diagonal: parts nearer than this may have touched
const float FLAGGED_GAIN = 0.1;    // m g d
const float FLAGGED_RATIO = 2.0;   // of speeds

shared vec4 ball[SPHERE_MAX_BODIES];   // in which a body was since the last observation; w: radius, negative: no body
shared vec4 terms[SPHERE_MAX_BODIES];  // change, gain, unit of the world's sum; gain, speed, restitution of a group
shared float gain[SPHERE_MAX_BODIES];  // J; then as a share of m g d
shared float before[SPHERE_MAX_BODIES], now[SPHERE_MAX_BODIES];  // m/s: of the fastest point then; then ratio
shared uint label[SPHERE_MAX_BODIES];  // lowest body of the group
shared uint changed[2];                // take turns
shared uint begins, gained, faster;

SphereWorld world;
float gravity, seconds;
#define FOR_OWN(i) for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_WORLD_GROUP)

bool is_audited(uint body) { return is_watched(body) && (states[body].flags.x & SPHERE_OUTSIDE) == 0u; }

// m g d
float unit_of(uint body) { return gravity * bodies[body].material.w / bodies[body].material.x; }
float least_speed(uint body) { return sqrt(2.0 * FLAGGED_GAIN * gravity * bodies[body].material.w); }

// By a displacement (m).
float potential_change(uint body, vec3 shift) { return -dot(world.gravity.xyz, shift) / bodies[body].material.x; }

// A body that moved since the last observation: the ball that it was in, its gain and speeds.
void compare_with_before(uint i, uint body, SphereState s, float kinetic, float worst_gain) {
  SphereWatched w = watched[body];
  vec3 shift = shift_from(w.before.xyz, w.before_rest.xyz, s);
  float speed = length(s.velocity.xyz), size = bodies[body].material.w;
  float distance = max(0.5 * (w.before_rest.w + speed) * seconds, length(shift));
  float radius = shapes[bodies[body].ids.x].box_center.w;
  ball[i] = vec4(s.position.xyz - 0.5 * shift, radius + 0.5 * distance + 0.5 * TOUCHING * size);
  gain[i] = kinetic - w.before.w + potential_change(body, shift) - ALLOWED * max(kinetic, w.before.w);
  before[i] = w.audited.x;
  now[i] = speed;
  if (gain[i] > worst_gain * unit_of(body)) gained = 1u;
  if (speed > least_speed(body) && speed > FLAGGED_RATIO * before[i] + gravity * seconds) faster = 1u;
}

// What a body adds to the sums over all of them.
vec4 terms_of(uint body, SphereState s, float kinetic) {
  SphereWatched w = watched[body];
  float swiftest = max(w.least_rest.w, kinetic), unit = unit_of(body);
  watched[body].least_rest.w = swiftest;
  float more = kinetic - w.least.w + potential_change(body, shift_from(w.least.xyz, w.least_rest.xyz, s));
  bool moved = abs(more) > STIRS * unit || swiftest > SWIFT * unit;
  return vec4(more, (moved ? more : min(more, 0.0)) - ALLOWED * swiftest, moved ? unit : 0.0, 0.0);
}

void observe(uint i, bool driven, float worst_gain) {
  uint body = world.bodies.x + i;
  ball[i] = vec4(0.0, 0.0, 0.0, -1.0);
  terms[i] = vec4(0.0);
  gain[i] = before[i] = now[i] = 0.0;
  label[i] = i;
  if (!is_audited(body)) {
    if (watched[body].audited.y != 0.0) begins = 1u;  // it has left
    watched[body].audited.y = 0.0;
    return;
  }
  SphereState s = states[body];
  float kinetic = kinetic_of(body, s);
  if (driven)
    keep_least(body, s, kinetic, watched[body].least_rest.w);
  else
    compare_with_before(i, body, s, kinetic, worst_gain);
  keep_before(body, s, kinetic);
  terms[i] = terms_of(body, s, kinetic);
}

// Into the first entry, by a tree that depends on nothing but their number.
void sum_terms() {
  for (uint reach = 1u; reach < world.bodies.y; reach *= 2u) {
    FOR_OWN(i) if ((i & (2u * reach - 1u)) == 0u && i + reach < world.bodies.y) terms[i] += terms[i + reach];
    barrier();
  }
}

void keep_world_gain(uint w, uint observation) {
  if (terms[0].y <= audits[w].world_gain * terms[0].z) return;
  audits[w].world_gain = terms[0].y / terms[0].z;
  audits[w].world_observation = observation;
}

bool may_have_touched(uint i, uint j) {
  vec3 apart = ball[i].xyz - ball[j].xyz;
  float near = ball[i].w + ball[j].w;
  return ball[i].w >= 0.0 && ball[j].w >= 0.0 && dot(apart, apart) <= near * near;
}

// While others may lower it.
uint label_now(uint i) { return atomicOr(label[i], 0u); }

void join_groups() {
  for (uint round = 0u;; ++round) {
    uint turn = round & 1u;
    FOR_OWN(i) for (uint j = 0u; j < i; ++j) {
      if (!may_have_touched(i, j)) continue;
      uint a = label_now(i), b = label_now(j);
      if (a == b) continue;
      atomicMin(label[i], b);
      atomicMin(label[j], a);
      atomicMin(label[max(a, b)], min(a, b));
      changed[turn] = 1u;
    }
    barrier();
    if (changed[turn] == 0u) break;
    FOR_OWN(i) atomicMin(label[i], label_now(label_now(i)));
    if (gl_LocalInvocationIndex == 0u) changed[turn ^ 1u] = 0u;
    barrier();
  }
}

// Of the group whose lowest body is i, in the order of its bodies: sum of gains, largest speed and restitution.
void add_up_group(uint i) {
  vec4 sum = vec4(0.0, 0.0, world.ground.y, 0.0);
  for (uint j = i; j < world.bodies.y; ++j) {
    if (ball[j].w < 0.0 || label[j] != i) continue;
    sum = vec4(sum.x + gain[j], max(sum.y, before[j]), max(sum.z, bodies[world.bodies.x + j].material.z), 0.0);
  }
  terms[i] = sum;
}

// Of body i: its gain, limited to that of its group, and how much faster it is than all that was near it, as far as
// these are worse than the worst so far.
void compare_with_group(uint i, uint w) {
  uint body = world.bodies.x + i;
  vec4 group = terms[label[i]];
  float share = ball[i].w < 0.0 ? 0.0 : min(gain[i], group.x) / unit_of(body);
  gain[i] = gained != 0u && share > audits[w].gain ? share : 0.0;
  float fall = gravity * seconds;
  float ratio = ball[i].w < 0.0 || now[i] <= least_speed(body)
                    ? 0.0
                    : (now[i] - fall) / (max(group.y, fall) * (1.0 + group.z));
  now[i] = faster != 0u && ratio > max(audits[w].ratio, 1.0) ? ratio : 0.0;
}

uint nearest_of_group(uint i) {
  uint nearest = SPHERE_GROUND;
  float least = 3.4e38;
  for (uint k = 0u; k < world.bodies.y; ++k) {
    if (k == i || ball[k].w < 0.0 || label[k] != label[i]) continue;
    float gap = distance(ball[k].xyz, ball[i].xyz) - ball[k].w - ball[i].w;
    if (gap >= least) continue;
    least = gap;
    nearest = k;
  }
  return nearest;
}

// By one invocation: it is rare that anything gained. Of bodies that are equal the first counts.
void keep_worst(uint w, uint observation) {
  float best_gain = 0.0, best_ratio = 0.0;
  uint gainer = SPHERE_GROUND, thrown = SPHERE_GROUND;
  for (uint i = 0u; i < world.bodies.y; ++i) {
    if (gain[i] > best_gain) {
      best_gain = gain[i];
      gainer = i;
    }
    if (now[i] > best_ratio) {
      best_ratio = now[i];
      thrown = i;
    }
  }
  if (best_gain > 0.0) {
    audits[w].gain = best_gain;
    audits[w].gainer = gainer;
    audits[w].gain_observation = observation;
  }
  if (!(best_ratio > 0.0)) return;
  audits[w].ratio = best_ratio;
  audits[w].thrown = thrown;
  audits[w].beside = nearest_of_group(thrown);
  audits[w].ratio_observation = observation;
}

void main() {
  uint w = running[gl_WorkGroupID.x], thread = gl_LocalInvocationIndex;
  SphereAsk ask = asks[w];
  if (ask.observation == 0u || progress[w].steps_left != 0u || progress[w].overflow != 0u) return;
  world = worlds[w];
  gravity = length(world.gravity.xyz);
  if (gravity == 0.0) gravity = EARTH;
  seconds = ask.seconds;
  bool driven = (ask.flags & SPHERE_DRIVEN) != 0u;
  if (thread == 0u) {
    begins = driven ? 1u : audits[w].begins;
    gained = faster = 0u;
  }
  if (thread < 2u) changed[thread] = 0u;
  barrier();
  float worst_gain = audits[w].gain;
  FOR_OWN(i) observe(i, driven, worst_gain);
  barrier();
  sum_terms();
  bool least = begins != 0u || terms[0].x <= 0.0;
  FOR_OWN(i) if (least && ball[i].w >= 0.0) {
    SphereState s = states[world.bodies.x + i];
    keep_least(world.bodies.x + i, s, watched[world.bodies.x + i].before.w, 0.0);
  }
  if (thread == 0u) {
    keep_world_gain(w, ask.observation);
    audits[w].begins = 0u;
    asks[w].observation = 0u;  // it is done
  }
  if ((gained | faster) == 0u) return;
  join_groups();
  FOR_OWN(i) if (label[i] == i) add_up_group(i);
  barrier();
  FOR_OWN(i) compare_with_group(i, w);
  barrier();
  if (thread == 0u) keep_worst(w, ask.observation);
}
