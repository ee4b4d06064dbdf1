// Per touching body, one group each: gathers the pushes of its spheres in a fixed order (OpenGL 4.5 has no float
// atomics, and they would not be repeatable) and changes the velocities (eqs 2.18-2.21).
#include "shared/thesis.h"
#include "shared/rotation.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_BODY_GROUP) in;

layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { ThesisState states[]; };
layout(std430, binding = BIND_INERTIAS) readonly buffer Inertias { ThesisInertia inertias[]; };
layout(std430, binding = BIND_CONTACT_RANGES) readonly buffer ContactRanges { ThesisRange contact_ranges[]; };
layout(std430, binding = BIND_TOUCHING_BODIES) readonly buffer TouchingBodies { uint touching_bodies[]; };
layout(std430, binding = BIND_PUSHES) readonly buffer Pushes { ThesisPush pushes[]; };
layout(std430, binding = BIND_STATUS) readonly buffer Status { ThesisStatus status; };

shared vec3 linear[THESIS_BODY_GROUP], angular[THESIS_BODY_GROUP];

void main() {
  uint thread = gl_LocalInvocationIndex;
  bool present = group_index() < status.touching_bodies;
  uint body = present ? touching_bodies[group_index()] : 0u;
  uint first = bodies[body].range.x, end = present ? first + bodies[body].range.y : 0u;

  linear[thread] = angular[thread] = vec3(0.0);
  for (uint s = first + thread; s < end; s += THESIS_BODY_GROUP) {
    if (contact_ranges[s].count == 0u) continue;
    linear[thread] += pushes[s].linear.xyz;
    angular[thread] += pushes[s].angular.xyz;
  }
  barrier();
  if (thread != 0u || !present) return;

  vec3 push = linear[0], turn = angular[0];
  for (uint i = 1u; i < THESIS_BODY_GROUP; ++i) {
    push += linear[i];
    turn += angular[i];
  }
  states[body].velocity.xyz += bodies[body].inverse_inertia.w * push;
  states[body].spin.xyz += symmetric_times(inertias[body].diagonal.xyz, inertias[body].mixed.xyz, turn);
}
