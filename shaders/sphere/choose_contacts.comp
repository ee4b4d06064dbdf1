// A group takes one pair after the other from the list of jobs: of its candidates the few contacts that stand for all,
// with the forces of the last step. Choices go by depth and spread, ties by feature, so that neither the order of the
// candidates nor who found them matters. Where some are missing the step is repeated: what is chosen before is kept, as
// of a pair that has not moved. Twin: reduce().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_PAIR_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_CANDIDATES) buffer Candidates { SphereCandidate candidates[]; };

#include "sphere/step_of_pair.h"
#include "sphere/reduce.h"

shared uint job_taken, has_candidates[2];  // take turns

// Contacts of balls are found anew in each attempt: they must not be chosen by those of the last one.
bool is_kept(SpherePair pair) { return !is_ball(pair.a) && !is_ball(pair.b); }

void main() {
  if (gl_LocalInvocationIndex == 0u) has_candidates[0] = 0u;
  for (uint n = 0u; n < SPHERE_GROUP_JOBS; ++n) {
    if (gl_LocalInvocationIndex == 0u) job_taken = atomicAdd(status.next_choice, 1u);
    barrier();
    uint job = job_taken;
    if (job >= status.jobs) break;
    if (gl_LocalInvocationIndex == 0u) has_candidates[~n & 1u] = 0u;  // for the next job
    SpherePair pair = pairs[jobs[job].pair];
    take_world_of(pair);
    take_chain(job);
    if (chain != 0u) atomicOr(has_candidates[n & 1u], 1u);
    barrier();
    if (jobs[job].incomplete == 0u && (progress[world_index].overflow == 0u || is_kept(pair))) {
      if (has_candidates[n & 1u] == 0u) {
        if (gl_LocalInvocationIndex == 0u) end_choice(worlds[world_index], pair, 0u);
        continue;
      }
      begin_choice(worlds[world_index], pair.slot);
      barrier();
      begin_candidates();
      choose_contacts(worlds[world_index], pair);
    } else {
      barrier();  // all know it
      if (gl_LocalInvocationIndex == 0u) jobs[job].incomplete = 0u;
    }
  }
}
