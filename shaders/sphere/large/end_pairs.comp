// One group: the new list of pairs takes the old one's place, and the passes over pairs learn how many groups.
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_PAIR_STARTS) readonly buffer PairStarts { uint pair_starts[]; };

#include "sphere/large/large_world.h"

const uvec4 NONE = uvec4(0u, 1u, 1u, 0u);

void main() {
  for (uint k = gl_LocalInvocationIndex; k < SPHERE_COLORS * SPHERE_MAX_CONTACTS; k += SPHERE_GROUP)
    large.members[k] = 0u;
  if (gl_LocalInvocationIndex != 0u) return;
  SphereWorld world = worlds[large_world];
  bool idles = idle();
  uint page = progress[large_world].page ^ 1u, count = idles ? 0u : pair_starts[world.bodies.y];
  if (!idles) {
    progress[large_world].page = page;
    progress[large_world].pairs = count;
    progress[large_world].refresh = 0u;
  }
  large.list = 2u * world.pairs.x + page * world.pairs.y;
  large.pair_groups = uvec4(folded_groups((count + SPHERE_GROUP - 1u) / SPHERE_GROUP), 0u);
  for (uint k = 0u; k <= SPHERE_MOST_ROUNDS; ++k) large.round_groups[k] = NONE;
  for (uint c = 0u; c < SPHERE_COLORS; ++c) large.color_groups[c] = NONE;
  large.manifold_groups = large.rest_groups = NONE;
  large.bounced = 0u;
}
