// Per body: new position and orientation (eqs 2.22-2.26).
// Eq 2.19 keeps the angular momentum while the inertia turns with the body; here both change together: implicit
// midpoint with the momentum L held, which neither gains nor loses energy over time where explicit Euler gains.
#include "shared/thesis.h"
#include "shared/rotation.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { ThesisWorld worlds[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { ThesisState states[]; };
layout(std430, binding = BIND_NEIGHBOUR_COUNTS) readonly buffer NeighbourCounts { uint neighbour_counts[]; };

vec3 spin_of(vec4 q, vec3 momentum, vec3 inverse_inertia) {
  return rotate(q, inverse_inertia * rotate(quat_conjugate(q), momentum));
}

void main() {
  uint b = thread_index();
  if (b >= settings.bodies || bodies[b].inverse_inertia.w == 0.0) return;
  float dt = settings.time_step;

  // Gravity was added before the step. A body that touches nothing moves with the mean of old and new velocity, which
  // is exact in free fall; where something pushes back, the new velocity counts.
  vec3 travel = dt * states[b].velocity.xyz;
  if (neighbour_counts[b] == 0u) travel -= 0.5 * dt * dt * worlds[bodies[b].range.z].gravity.xyz;
  states[b].position.xyz += travel;

  vec4 q = states[b].orientation;
  vec3 w = states[b].spin.xyz, inverse = bodies[b].inverse_inertia.xyz;
  vec3 momentum = rotate(q, rotate(quat_conjugate(q), w) / inverse);
  for (int i = 0; i < 6; ++i) w = spin_of(quat_multiply(quat_of_turn(0.5 * dt * w), q), momentum, inverse);
  q = normalize(quat_multiply(quat_of_turn(dt * w), q));
  q *= 1.5 - 0.5 * dot(q, q);  // built-in normalize may be off by 1e-7 to one side, and ten thousand steps add that up
  states[b].orientation = q;
  states[b].spin.xyz = spin_of(q, momentum, inverse);
}
