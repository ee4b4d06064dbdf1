// Per body: gravity on the velocity, inverse inertia in world axes (R I0^-1 R^T), step marks reset.
#include "shared/thesis.h"
#include "shared/rotation.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { ThesisWorld worlds[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { ThesisState states[]; };
layout(std430, binding = BIND_INERTIAS) writeonly buffer Inertias { ThesisInertia inertias[]; };
layout(std430, binding = BIND_NEIGHBOUR_COUNTS) writeonly buffer NeighbourCounts { uint neighbour_counts[]; };

void main() {
  uint b = thread_index();
  if (b >= settings.bodies) return;
  neighbour_counts[b] = 0u;

  vec3 i0 = bodies[b].inverse_inertia.xyz;
  vec4 q = states[b].orientation;
  vec3 x = rotate(q, vec3(1, 0, 0)), y = rotate(q, vec3(0, 1, 0)), z = rotate(q, vec3(0, 0, 1));
  inertias[b].diagonal = vec4(i0.x * x * x + i0.y * y * y + i0.z * z * z, 0.0);
  inertias[b].mixed = vec4(i0.x * x.x * x.y + i0.y * y.x * y.y + i0.z * z.x * z.y,
                           i0.x * x.x * x.z + i0.y * y.x * y.z + i0.z * z.x * z.z,
                           i0.x * x.y * x.z + i0.y * y.y * y.z + i0.z * z.y * z.z, 0.0);

  if (bodies[b].inverse_inertia.w == 0.0) return;
  states[b].velocity.xyz += settings.time_step * worlds[bodies[b].range.z].gravity.xyz;
}
