// One invocation follows a chain of addresses, each of which it has to load first: the latency of the memory that holds
// a chain of this length. MAKE: writes the chain, one link in each line of 128 bytes.
#include "shared/dispatch.h"

layout(local_size_x = 64) in;

layout(std430, binding = 0) buffer Chain { uint next[]; };
layout(std430, binding = 1) buffer Result { uint result[]; };

uniform uint lines;  // a power of two
uniform uint hops;

void main() {
  uint i = thread_index();
#ifdef MAKE
  // A linear congruence of full period (Knuth, The Art of Computer Programming 2, 3.2.1.2) visits each line once.
  if (i < lines) next[32u * i] = 32u * ((1664525u * i + 1013904223u) & (lines - 1u));
#else
  if (i != 0u) return;
  uint at = result[0];
  for (uint k = 0u; k < hops; ++k) at = next[at];
  result[0] = at;
#endif
}
