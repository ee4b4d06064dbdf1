// Per touching sphere: the impulse of each of its contacts from the velocities as they are (eqs 2.10-2.16, 2.30, 3.5).
#include "shared/thesis.h"
#include "shared/rotation.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { ThesisState states[]; };
layout(std430, binding = BIND_INERTIAS) readonly buffer Inertias { ThesisInertia inertias[]; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CONTACT_RANGES) readonly buffer ContactRanges { ThesisRange contact_ranges[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { ThesisContact contacts[]; };
layout(std430, binding = BIND_NEIGHBOUR_COUNTS) readonly buffer NeighbourCounts { uint neighbour_counts[]; };
layout(std430, binding = BIND_TOUCHING_SPHERES) readonly buffer TouchingSpheres { uint touching_spheres[]; };
layout(std430, binding = BIND_STATUS) readonly buffer Status { ThesisStatus status; };

#include "thesis/contact_impulse.h"

// One side of a contact. A sheet of the bin is a body that never moves.
Side side_of(uint body) {
  float split = lighter(neighbour_counts[body]);
  Side side;
  side.velocity = states[body].velocity.xyz;
  side.spin = states[body].spin.xyz;
  side.position = states[body].position.xyz;
  side.inverse_mass = split * bodies[body].inverse_inertia.w;
  side.diagonal = split * inertias[body].diagonal.xyz;
  side.mixed = split * inertias[body].mixed.xyz;
  return side;
}

void main() {
  uint t = thread_index();
  if (t >= status.touching_spheres) return;
  uint s = touching_spheres[t];
  uint body = spheres[s].body;
  ThesisRange range = contact_ranges[s];
  Side own = side_of(body);
  for (uint c = range.first; c < range.first + range.count; ++c) {
    ThesisContact contact = contacts[c];
    Side other = still;
    if ((contact.other.y & THESIS_NODE) == 0u) other = side_of(contact.other.y);
    vec3 other_arm = contact.arm.xyz + own.position - other.position;
    vec3 p = contact_impulse(contact, own, other, other_arm);
    contacts[c].impulse.xyz = p;
    contacts[c].total.xyz += p;
  }
}
