// Per sphere of a moving body: its centre in the world.
#include "shared/thesis.h"
#include "shared/rotation.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_STATES) readonly buffer States { ThesisState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { ThesisShape shapes[]; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CENTERS) writeonly buffer Centers { vec4 centers[]; };

uniform uint first, count;  // static spheres are moved once, when they are loaded

void main() {
  uint s = first + thread_index();
  if (s >= first + count) return;
  ThesisSphere sphere = spheres[s];
  vec4 local = shapes[sphere.shape].center;
  centers[s] = vec4(states[sphere.body].position.xyz + rotate(states[sphere.body].orientation, local.xyz), local.w);
}
