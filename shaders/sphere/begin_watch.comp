// One group a world, before its steps: how many they are, and which bodies the watch begins anew with. A body that came
// in is audited from its state of now on; one that was taken out is left out, and the energy of all parts together
// begins anew.
#include "shared/sphere.h"

layout(local_size_x = SPHERE_WORLD_GROUP) in;

layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_ASKS) readonly buffer Asks { SphereAsk asks[]; };
layout(std430, binding = BIND_WATCHED) buffer Watched { SphereWatched watched[]; };
layout(std430, binding = BIND_AUDITS) buffer Audits { SphereAudit audits[]; };

#include "sphere/body.h"
#include "sphere/watched.h"

void begin_body(uint body, uint w, bool anew) {
  bool enters = states[body].flags.z != 0u;
  states[body].flags.z = 0u;
  if (!is_watched(body)) {
    if (watched[body].audited.y != 0.0 && !anew) audits[w].begins = 1u;  // all that write this write the same
    watched[body].audited.y = 0.0;
    return;
  }
  if (!enters && !anew) return;
  SphereState s = states[body];
  float kinetic = kinetic_of(body, s);
  keep_before(body, s, kinetic);
  keep_least(body, s, kinetic, anew ? 0.0 : watched[body].least_rest.w);
}

void begin_counters(uint w) {
  progress[w].steps = progress[w].free_steps = progress[w].asleep_steps = 0u;
  progress[w].pairs_tested = progress[w].pairs_recycled = progress[w].pairs_asleep = progress[w].pairs_culled = 0u;
  progress[w].clusters_tested = progress[w].nodes_tested = progress[w].nodes_possible = 0u;
  progress[w].nodes_possible_high = progress[w].contacts = progress[w].dropped = progress[w].colors = 0u;
  progress[w].coloring_rounds = progress[w].lists_made = progress[w].colorings = 0u;
}

void main() {
  uint w = running[gl_WorkGroupID.x];
  SphereWorld world = worlds[w];
  uint flags = asks[w].flags;
  bool anew = (flags & SPHERE_ENERGY_ANEW) != 0u;
  for (uint i = gl_LocalInvocationIndex; i < world.bodies.y; i += SPHERE_WORLD_GROUP) {
    uint body = world.bodies.x + i;
    if ((flags & SPHERE_REST_ANEW) != 0u) states[body].flags.w = 0u;
    begin_body(body, w, anew);
  }
  if (gl_LocalInvocationIndex != 0u) return;
  if (anew) audits[w] = SphereAudit(0.0, 0u, 0u, 0.0, 0u, 0u, 0u, 0.0, 0u, 0u, 0u, 0u);
  progress[w].steps_left = asks[w].steps;
  if ((flags & SPHERE_COUNTED) != 0u) begin_counters(w);
}
