// One level of an exclusive prefix sum: each group scans a block of BLOCK elements.
//   PASS_SUM:  only the sum of each block, for the level above
//   otherwise: start of the block (from the level above) + exclusive scan inside the block
#include "shared/dispatch.h"

#define THREADS 64
#define PER_THREAD 16
#define BLOCK (THREADS * PER_THREAD)
layout(local_size_x = THREADS) in;

layout(std430, binding = 0) readonly buffer Input { uint values[]; };
#ifdef PASS_SUM
layout(std430, binding = 1) writeonly buffer Sums { uint sums[]; };
#else
layout(std430, binding = 1) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 2) writeonly buffer Result { uint result[]; };
#endif

uniform uint count;

shared uint partial[THREADS];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint first = group_index() * BLOCK + thread * PER_THREAD;

  uint own[PER_THREAD];
  uint sum = 0u;
  for (uint i = 0u; i < PER_THREAD; ++i) {
    own[i] = first + i < count ? values[first + i] : 0u;
    sum += own[i];
  }
  partial[thread] = sum;
  barrier();

  // One barrier and up to THREADS adds: where barriers are dear (llvmpipe) this beats a logarithmic scan.
#ifdef PASS_SUM
  if (thread == 0u && first < count) {
    for (uint i = 1u; i < THREADS; ++i) sum += partial[i];
    sums[group_index()] = sum;
  }
#else
  uint blocks = (count + BLOCK - 1u) / BLOCK;
  uint running = starts[min(group_index(), blocks)];
  for (uint i = 0u; i < thread; ++i) running += partial[i];
  for (uint i = 0u; i < PER_THREAD; ++i) {
    if (first + i <= count) result[first + i] = running;  // result[count] = total
    running += own[i];
  }
#endif
}
