// A group takes some pairs at a time from the list of jobs: of their candidates the few contacts that stand for all,
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

const uint LEAST_JOBS = 8u;  // at a time

shared uint first_job, with_candidates[SPHERE_GROUP_JOBS], with_candidates_count;

// Contacts of balls are found anew in each attempt: they must not be chosen by those of the last one.
bool is_kept(SpherePair pair) { return !is_ball(pair.a) && !is_ball(pair.b); }

bool has_candidates(uint job) {
  for (uint i = 0u; i < SPHERE_CHAINS; ++i)
    if (jobs[job].chains[i] != 0u) return true;
  return false;
}

// An invocation a job: those without candidates end here, the others are listed.
void list_job(uint job) {
  SpherePair pair = pairs[jobs[job].pair];
  take_world_of(pair);
  bool complete = jobs[job].incomplete == 0u && (progress[world_index].overflow == 0u || is_kept(pair));
  if (!complete) {
    jobs[job].incomplete = 0u;
    for (uint i = 0u; i < SPHERE_CHAINS; ++i) jobs[job].chains[i] = 0u;
  } else if (has_candidates(job)) {
    with_candidates[atomicAdd(with_candidates_count, 1u)] = job;
  } else {
    end_choice(worlds[world_index], pair, 0u, 0u);
  }
}

// All invocations: number k of the jobs with candidates, if there is one.
void choose_for(uint k) {
  bool has_pair = k < with_candidates_count;
  uint job = with_candidates[has_pair ? k : 0u];
  SpherePair pair = pairs[jobs[job].pair];
  take_world_of(pair);
  chain = 0u;
  if (has_pair) take_chain(job);
  begin_choice(has_pair, worlds[world_index].pairs.x + pair.slot);
  barrier();
  begin_candidates();
  choose_contacts(pair, has_pair);
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint at_once = clamp(status.jobs / settings.contact_groups, LEAST_JOBS, SPHERE_GROUP_JOBS);
  join_team();
  if (thread == 0u) goes_on[0] = goes_on[1] = 0u;
  for (uint n = 0u; n < SPHERE_GROUP_JOBS; n += at_once) {
    if (thread == 0u) {
      first_job = atomicAdd(status.next_choice, at_once);
      with_candidates_count = 0u;
    }
    barrier();
    uint first = first_job;
    if (first >= status.jobs) break;
    if (thread < min(at_once, status.jobs - first)) list_job(first + thread);
    barrier();
    for (uint k = 0u; k < with_candidates_count; k += TEAMS) {
      choose_for(k + team);
      barrier();
    }
    barrier();
  }
}
