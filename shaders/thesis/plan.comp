// One invocation: how much of what follows there is to do. Nothing touches: the indirect dispatches are empty.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = 1) in;

layout(std430, binding = BIND_STATUS) buffer Status { ThesisStatus status; };

void main() {
  status.sphere_groups = uvec4(folded_groups((status.touching_spheres + THESIS_GROUP - 1u) / THESIS_GROUP), 0u);
  status.body_groups = uvec4(folded_groups(status.touching_bodies), 0u);
}
