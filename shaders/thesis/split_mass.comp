// Per touching sphere: writes k, the number of contacts between the same two bodies, into each contact (eq 3.5).
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CONTACT_RANGES) readonly buffer ContactRanges { ThesisRange contact_ranges[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { ThesisContact contacts[]; };
layout(std430, binding = BIND_NEIGHBOURS) readonly buffer Neighbours { ThesisNeighbour neighbours[]; };
layout(std430, binding = BIND_TOUCHING_SPHERES) readonly buffer TouchingSpheres { uint touching_spheres[]; };
layout(std430, binding = BIND_STATUS) readonly buffer Status { ThesisStatus status; };

#include "thesis/neighbours.h"

uint contacts_between(uint body, uint key) {
  for (uint probe = 0u; probe < settings.neighbour_slots; ++probe) {
    uint slot = neighbour_slot(body, key, probe);
    if (neighbours[slot].key == key) return neighbours[slot].count + 1u;
  }
  return 1u;  // the table was full: the step will be repeated with a larger one
}

void main() {
  uint t = thread_index();
  if (t >= status.touching_spheres) return;
  uint s = touching_spheres[t];
  ThesisRange own = contact_ranges[s];
  for (uint c = own.first; c < own.first + own.count; ++c)
    contacts[c].other.z = contacts_between(spheres[s].body, contacts[c].other.y);
}
