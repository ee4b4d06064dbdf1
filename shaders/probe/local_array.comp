// Reads and writes of an array that is indexed at run time, which lies in local memory. REGISTERS: the same number of
// operations on two registers.
layout(local_size_x = 32) in;

layout(std430, binding = 0) buffer Values { uint values[]; };

uniform uint rounds;

void main() {
  uint lane = gl_LocalInvocationIndex, x = values[lane];
#ifdef REGISTERS
  uint other = x;
  for (uint k = 0u; k < rounds; ++k) {
    uint before = other;
    other = x;
    x = before + k;
  }
#else
  uint slots[16];
  for (uint k = 0u; k < 16u; ++k) slots[k] = x + k;
  for (uint k = 0u; k < rounds; ++k) {
    uint at = x & 15u, before = slots[at];
    slots[(at + 5u) & 15u] = x;
    x = before + k;
  }
#endif
  values[lane] = x;
}
