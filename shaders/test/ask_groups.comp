// Writes the arguments of an indirect dispatch.
#include "shared/dispatch.h"

layout(local_size_x = 1) in;

layout(std430, binding = 1) writeonly buffer Arguments { uint arguments[3]; };

uniform uint groups;

void main() {
  uvec3 folded = folded_groups(groups);
  arguments[0] = folded.x;
  arguments[1] = folded.y;
  arguments[2] = folded.z;
}
