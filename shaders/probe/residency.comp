// How many groups work at once, and on which multiprocessors, if each has SHARED words of shared memory. A group counts
// itself in, works for a while, keeps the largest count that it saw, and counts itself out.
#include "shared/dispatch.h"
#ifdef GL_NV_shader_thread_group
#extension GL_NV_shader_thread_group : enable
#endif

#ifndef SHARED
#define SHARED 2048
#endif
#ifndef GROUP
#define GROUP 64
#endif
layout(local_size_x = GROUP) in;

layout(std430, binding = 0) coherent buffer Result {
  uint now, most;
  uint groups_on[];  // by number of the multiprocessor
};

uniform uint rounds;

shared uint memory[SHARED];

void main() {
  uint i = gl_LocalInvocationIndex;
  for (uint k = i; k < uint(SHARED); k += uint(GROUP)) memory[k] = k;
  barrier();
  if (i == 0u) {
    atomicMax(most, atomicAdd(now, 1u) + 1u);
#ifdef GL_NV_shader_thread_group
    atomicAdd(groups_on[gl_SMIDNV], 1u);
#endif
  }
  uint at = i % uint(SHARED);
  for (uint k = 0u; k < rounds; ++k) at = (memory[at] + 7u) % uint(SHARED);
  barrier();
  memory[i % uint(SHARED)] = at;
  barrier();
  if (i == 0u) atomicAdd(now, 0xffffffffu + memory[0] / 0xfffffff0u);  // less one; so that the work is not left out
}
