// Decides whether a listed pair keeps its contacts (recycling) or has them found anew, and puts the pairs of the second
// kind on the list of jobs. Needs the bindings Settings, Progress, Manifolds, Contacts, Jobs, and sphere/pair.h.
#include "shared/language.h"
#include "shared/sphere/choice.h"
#include "sphere/contact_gap.h"

// The decisions about the contacts of a pair.
const uint FIND_ANEW = 0u, RECYCLE = 1u, RECYCLE_UNLESS_IT_STRIKES = 2u;

// Returns the displacement (m) up to which a pair keeps its contacts. w: index of the world.
float recycle_limit(SpherePair pair, uint w) {
  float pressed = progress[w].stiffness == SPHERE_SOFT ? settings.recycle : settings.pressed_recycle;
  return (progress[w].fine != 0u ? pressed : settings.coarse_recycle) * size_of(pair);
}

// Decides whether a pair keeps its contacts, which it does if it has hardly moved since they were found. Contacts of a
// ball are always found anew: kept ones would rotate with the ball and accelerate it. w: index of the world.
uint fate_of_contacts(SphereWorld world, SpherePair pair, uint w) {
  SphereManifold manifold = manifolds[world.pairs.x + pair.slot];
  if (manifold.state.z == 0u || is_ball(pair.a) || is_ball(pair.b)) return FIND_ANEW;
  float limit = recycle_limit(pair, w);
  vec3 position;
  vec4 orientation;
  relative_pose(pair, position, orientation);
  vec4 turn = quat_multiply(quat_conjugate(manifold.found_orientation), orientation);
  float moved = max(length(position - manifold.found_position), length(turn.xyz) * size_of(pair));
  if (moved >= limit) return FIND_ANEW;
  return moved <= STRIKE * limit ? RECYCLE : RECYCLE_UNLESS_IT_STRIKES;
}

// Adds a pair to the list of jobs. place: index in the list of pairs.
void enlist(uint place) {
  uint job = atomicAdd(status.jobs, 1u);
  jobs[job].pair = place;
  uint groups = job < settings.contact_groups ? job + 1u : job / SPHERE_GROUP_JOBS + 1u;
  // A dispatch has at most 65,535 groups along an axis; groups that find no job end immediately.
  atomicMax(status.groups.x, min(groups, 65535u));
  atomicMax(status.groups.y, (groups + 65534u) / 65535u);
}
