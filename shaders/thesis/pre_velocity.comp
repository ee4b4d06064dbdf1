// Per touching sphere: linear and angular push of all its contacts together.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_CONTACT_RANGES) readonly buffer ContactRanges { ThesisRange contact_ranges[]; };
layout(std430, binding = BIND_CONTACTS) readonly buffer Contacts { ThesisContact contacts[]; };
layout(std430, binding = BIND_TOUCHING_SPHERES) readonly buffer TouchingSpheres { uint touching_spheres[]; };
layout(std430, binding = BIND_PUSHES) writeonly buffer Pushes { ThesisPush pushes[]; };
layout(std430, binding = BIND_STATUS) readonly buffer Status { ThesisStatus status; };

void main() {
  uint t = thread_index();
  if (t >= status.touching_spheres) return;
  uint s = touching_spheres[t];
  vec3 linear = vec3(0.0), angular = vec3(0.0);
  ThesisRange own = contact_ranges[s];
  for (uint c = own.first; c < own.first + own.count; ++c) {
    linear += contacts[c].impulse.xyz;
    angular += cross(contacts[c].arm.xyz, contacts[c].impulse.xyz);
  }
  pushes[s] = ThesisPush(vec4(linear, 0.0), vec4(angular, 0.0));
}
