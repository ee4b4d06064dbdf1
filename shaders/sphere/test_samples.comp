// One invocation a sample that is near the other body: to where it, or its edge, is deepest, which waits for
// offer_contacts; edges that cross are candidates at once. Twin: test_samples() in sample_test.cpp.
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
layout(std430, binding = BIND_SAMPLES) readonly buffer NearSamples { SphereSample samples[]; };
layout(std430, binding = BIND_TOUCHES) writeonly buffer Touches { SphereTouch touches[]; };

#include "sphere/sample_view.h"
#include "sphere/sample_kinds.h"

// There are no more touches than samples, and room for as many.
void put(View view, Touch touch, uint feature) {
  uint at = atomicAdd(status.touches, 1u);
  touches[at] = SphereTouch(job, feature | view.side, touch.distance, 0u, vec4(touch.point, 0.0),
                            vec4(touch.gradient, 0.0));
  if (at % SPHERE_PAIR_GROUP != 0u) return;
  uvec3 groups = folded_groups(at / SPHERE_PAIR_GROUP + 1u);
  atomicMax(status.touch_groups.x, groups.x);
  atomicMax(status.touch_groups.y, groups.y);
}

void test_sample(View view, uint feature) {
  uint i = feature & ~SPHERE_EDGE;
  bool of_edge = (feature & SPHERE_EDGE) != 0u, offers;
  uint a = i, b = i;
  if (of_edge) {
    Edge edge = edge_at(view.samples, i);
    a = edge.a;
    b = edge.b;
  }
  Touch p, touch;
  touches_of(view, a, b, p, touch);
  if (of_edge)
    offers = touches_with_edge(view, i, p, touch, touch);
  else
    offers = touches_with_node(view, i, touch);
  if (offers) put(view, touch, feature);
}

void main() {
  uint block = group_index(), kind = 0u;
  while (kind < SPHERE_SAMPLE_KINDS && block >= blocks_of_kind(kind)) block -= blocks_of_kind(kind++);
  uint of_kind = block * SPHERE_PAIR_GROUP + gl_LocalInvocationIndex;
  if (kind == SPHERE_SAMPLE_KINDS || of_kind >= status.sample_kinds[kind]) return;
  uint at = place_of_sample(kind, of_kind);
  job = samples[at].job;
  SpherePair pair = pairs[jobs[job].pair];
  take_world_of(pair);
  uint feature = samples[at].feature;
  bool of_a = (feature & SPHERE_SIDE_B) == 0u;
  View view = view_of(pair, placement_of(pair.a), placement_of(pair.b), of_a, margin_of(pair));
  test_sample(view, feature & ~SPHERE_SIDE_B);
}
