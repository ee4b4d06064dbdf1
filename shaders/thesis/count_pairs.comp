// Per touching sphere: counts its contacts by body pair, and lists the bodies that touch anything.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CONTACT_RANGES) readonly buffer ContactRanges { ThesisRange contact_ranges[]; };
layout(std430, binding = BIND_CONTACTS) readonly buffer Contacts { ThesisContact contacts[]; };
layout(std430, binding = BIND_NEIGHBOURS) buffer Neighbours { ThesisNeighbour neighbours[]; };
layout(std430, binding = BIND_NEIGHBOUR_COUNTS) buffer NeighbourCounts { uint neighbour_counts[]; };
layout(std430, binding = BIND_TOUCHING_SPHERES) readonly buffer TouchingSpheres { uint touching_spheres[]; };
layout(std430, binding = BIND_TOUCHING_BODIES) writeonly buffer TouchingBodies { uint touching_bodies[]; };
layout(std430, binding = BIND_STATUS) buffer Status { ThesisStatus status; };
layout(std430, binding = BIND_NEEDS) buffer Needs { ThesisNeed needs[]; };

#include "thesis/neighbours.h"

void count(uint body, uint key) {
  for (uint probe = 0u; probe < settings.neighbour_slots; ++probe) {
    uint slot = neighbour_slot(body, key, probe);
    uint found = atomicCompSwap(neighbours[slot].key, THESIS_NO_KEY, key);
    if (found != THESIS_NO_KEY && found != key) continue;
    atomicAdd(neighbours[slot].count, 1u);
    if (found == key) return;
    uint others = atomicAdd(neighbour_counts[body], 1u);
    if (others == 0u) touching_bodies[atomicAdd(status.touching_bodies, 1u)] = body;
    atomicMax(needs[bodies[body].range.z].neighbours, others + 1u);
    return;
  }
  atomicOr(status.overflow, THESIS_NEIGHBOUR_OVERFLOW);
  atomicMax(needs[bodies[body].range.z].neighbours, settings.neighbour_slots + 1u);
}

void main() {
  uint t = thread_index();
  if (t >= status.touching_spheres) return;
  uint s = touching_spheres[t];
  ThesisRange own = contact_ranges[s];
  for (uint i = 0u; i < own.count; ++i) count(spheres[s].body, contacts[own.first + i].other.y);
}
