// One invocation a sample that touches: to the candidates that come of it. Twin: offer(), test_samples() in
// sample_test.cpp.
#include "shared/sphere.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_PAIR_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_NODES) readonly buffer Nodes { SphereNode nodes[]; };
layout(std430, binding = BIND_EDGES) readonly buffer Edges { uvec4 edges[]; };
layout(std430, binding = BIND_FIELDS) readonly buffer Fields { vec2 fields[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_CANDIDATES) buffer Candidates { SphereCandidate candidates[]; };
layout(std430, binding = BIND_TOUCHES) readonly buffer Touches { SphereTouch touches[]; };

#include "sphere/sample_view.h"

void main() {
  uint at = thread_index();
  if (at >= status.touches) return;
  SphereTouch sample_at = touches[at];
  job = sample_at.job;
  SpherePair pair = pairs[jobs[job].pair];
  take_world_of(pair);
  bool of_a = (sample_at.feature & SPHERE_SIDE_B) == 0u;
  uint feature = sample_at.feature & ~SPHERE_SIDE_B, i = feature & ~SPHERE_EDGE;
  View view = view_of(pair, placement_of(pair.a), placement_of(pair.b), of_a, margin_of(pair));
  Cone cone;
  if (feature == i)
    cone = cone_at(view.samples, i);
  else
    cone = edge_at(view.samples, i).cone;
  offer(view, Touch(sample_at.point.xyz, sample_at.gradient.xyz, sample_at.distance), cone, feature);
}
