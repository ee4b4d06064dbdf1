// One invocation: how much of what follows there is to do. Nothing touches: the indirect dispatches are empty. Runs
// after the spheres that touch are known and again after the bodies are; the second time no slots are left to count.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = 1) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_STATUS) buffer Status { ThesisStatus status; };

void main() {
  status.sphere_groups = uvec4(folded_groups((status.touching_spheres + THESIS_GROUP - 1u) / THESIS_GROUP), 0u);
  status.body_groups = uvec4(folded_groups(status.touching_bodies), 0u);
  status.contacts += status.slots;
  // Steps after one without room go on from what it left out: their need says nothing.
  if (status.most_slots <= settings.slots) status.most_slots = max(status.most_slots, status.slots);
  status.slots = 0u;
}
