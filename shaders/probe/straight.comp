// Straight code of LENGTH times 64 multiplications with addition (16 bytes each on NVIDIA's cards), which each warp
// executes `rounds` times: what it costs when the code outgrows the caches of instructions.
#ifndef LENGTH
#define LENGTH A
#endif
#ifndef GROUP
#define GROUP 32
#endif
layout(local_size_x = GROUP) in;

layout(std430, binding = 0) buffer Values { float values[]; };

uniform uint rounds;

#define STEP x = x * y + 0.25; y = y * x + 0.5;
#define A STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP \
          STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP STEP
#define B A A A A A A A A A A A A A A A A
#define C B B

void main() {
  float x = values[gl_GlobalInvocationID.x & 31u], y = 0.001 * x;
  for (uint k = 0u; k < rounds; ++k) {
    LENGTH
  }
  values[gl_GlobalInvocationID.x & 31u] = x + y;
}
