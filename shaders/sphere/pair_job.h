// What is to be done about a listed pair. Needs the bindings Settings, Progress, Manifolds, Contacts, Jobs, and
// sphere/pair.h.
#include "shared/language.h"
#include "shared/sphere/choice.h"
#include "sphere/contact_gap.h"

uint recycled = 0u, tested = 0u, asleep = 0u, sleepers = 0u;

// Whether the pair has hardly moved since its contacts were found, on fine samples or on coarse ones. What strikes is
// found anew. The point where a ball touches stays below it, while one that is kept turns with it and drives it on.
bool recyclable(SphereWorld world, SpherePair pair, bool fine) {
  SphereManifold manifold = manifolds[world.pairs.x + pair.slot];
  if (manifold.state.z == 0u || is_ball(pair.a) || is_ball(pair.b)) return false;
  float size = size_of(pair), limit = (fine ? settings.recycle : settings.coarse_recycle) * size;
  vec3 position;
  vec4 orientation;
  relative_pose(pair, position, orientation);
  vec4 turn = quat_multiply(quat_conjugate(manifold.found_orientation), orientation);
  float moved = max(length(position - manifold.found_position), length(turn.xyz) * size), fresh = STRIKE * limit;
  return moved < limit && (moved <= fresh || !strikes(world, pair, fresh));
}

// Puts the pair at `place` of the list on the list of jobs, unless it sleeps or has hardly moved.
void enlist(SphereWorld world, uint w, SpherePair pair, uint place) {
  if (!moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b))) {
    ++asleep;
    return;
  }
  ++tested;
  if (recyclable(world, pair, progress[w].fine != 0u)) {
    ++recycled;
    return;
  }
  uint job = atomicAdd(status.jobs, 1u);
  jobs[job].pair = place;
  uint groups = job < settings.contact_groups ? job + 1u : job / SPHERE_GROUP_JOBS + 1u;
  // A dispatch takes 65,535 groups an axis; groups that find no job end at once.
  atomicMax(status.groups.x, min(groups, 65535u));
  atomicMax(status.groups.y, (groups + 65534u) / 65535u);
}

// What this invocation saw: pairs, and bodies that sleep.
void count_pairs(uint w) {
  atomicAdd(progress[w].pairs_tested, tested);
  atomicAdd(progress[w].pairs_recycled, recycled);
  atomicAdd(progress[w].pairs_asleep, asleep);
  atomicAdd(progress[w].asleep_steps, sleepers);
}
