// Barriers of a group, one after the other, each with a store and a load of shared memory between.
#ifndef GROUP
#define GROUP 64
#endif
layout(local_size_x = GROUP) in;

layout(std430, binding = 0) buffer Values { uint values[]; };

uniform uint rounds;

shared uint memory[GROUP];

void main() {
  uint i = gl_LocalInvocationIndex;
  memory[i] = values[i & 31u];
  barrier();
  for (uint k = 0u; k < rounds; ++k) {
    uint other = memory[(i + 1u) % uint(GROUP)];
    barrier();
    memory[i] = other + 1u;
    barrier();
  }
  if (i < 32u) values[i] = memory[i];
}
