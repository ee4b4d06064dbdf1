// One invocation a sample that is near the other body: to where it, or its edge, is deepest, and to the candidates that
// come of it. Twin: test_samples() in sample_test.cpp.
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
layout(std430, binding = BIND_FIELDS) readonly buffer Fields { float fields[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_CANDIDATES) buffer Candidates { SphereCandidate candidates[]; };
layout(std430, binding = BIND_SAMPLES) readonly buffer NearSamples { SphereSample samples[]; };

#include "sphere/sample_view.h"

// Both kinds end in one call of offer(), which is nearly all of the pass.
void test_sample(View view, uint feature) {
  uint i = feature & ~SPHERE_EDGE;
  bool of_edge = (feature & SPHERE_EDGE) != 0u, offers;
  Edge edge = Edge(i, i, Cone(0u, 0u), 0.0, 0u);
  if (of_edge) edge = edge_at(view.samples, i);
  Touch p, touch;
  touches_of(view, edge.a, edge.b, p, touch);
  if (of_edge) {
    offers = touches_with_edge(view, i, p, touch, touch);
  } else {
    edge.cone = cone_at(view.samples, i);
    offers = touches_with_node(view, i, touch);
  }
  if (offers) offer(view, touch, edge.cone, feature);
}

void main() {
  uint at = thread_index();
  if (at >= min(status.samples, settings.samples)) return;
  job = samples[at].job;
  SpherePair pair = pairs[jobs[job].pair];
  take_world_of(pair);
  uint feature = samples[at].feature;
  bool of_a = (feature & SPHERE_SIDE_B) == 0u;
  View view = view_of(pair, placement_of(pair.a), placement_of(pair.b), of_a, margin_of(pair));
  test_sample(view, feature & ~SPHERE_SIDE_B);
}
