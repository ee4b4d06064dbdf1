// One invocation per group writes its folded index: dispatches beyond 65,535 groups reach every item once.
#include "shared/dispatch.h"

layout(local_size_x = 1) in;

layout(std430, binding = 0) buffer Marks { uint marks[]; };

uniform uint count;

void main() {
  uint i = thread_index();
  if (i < count) atomicAdd(marks[i], i + 1u);
}
