// A group takes one pair after the other from the list of jobs: samples of each body against the field of the other,
// bounding spheres first, edges by descent, then the few contacts that stand for all, with the forces of the last
// step. An invocation keeps the candidates it finds; choices go by depth and spread, ties by feature, so that neither
// the order of arrival nor who tested what matters. Twin: find_contacts().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_PAIR_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_PLANES) readonly buffer Planes { SpherePlane planes[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_NODES) readonly buffer Nodes { SphereNode nodes[]; };
layout(std430, binding = BIND_EDGES) readonly buffer Edges { uvec4 edges[]; };
layout(std430, binding = BIND_CLUSTERS) readonly buffer Clusters { SphereCluster clusters[]; };
layout(std430, binding = BIND_FIELDS) readonly buffer Fields { float fields[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_MANIFOLDS) buffer Manifolds { SphereManifold manifolds[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; uint jobs[]; };
layout(std430, binding = BIND_CANDIDATES) buffer Candidates { SphereCandidate candidates[]; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/field.h"
#include "sphere/samples.h"
#include "sphere/placement.h"
#include "sphere/plan.h"

StepPlan plan;
uint world_index, clusters_tested, nodes_tested;

SphereSamples samples_of(uint body) {
  uint shape = bodies[body].ids.x;
  if (progress[world_index].fine != 0u) return shapes[shape].fine;
  return shapes[shape].coarse;
}

// Of a body of this world.
Placement placement_of(uint body) { return placement_of(body, plan.half_way); }

#include "sphere/reduce.h"
#include "shared/sphere/rim.h"

shared uint job;
shared uint near_clusters[SPHERE_MAX_CLUSTERS], near_count;
shared uint sample_queue[SPHERE_SAMPLE_QUEUE], queued;

// Where the samples of one body lie in the frame of the field, and what is found there in the frame of a.
struct View {
  Samples samples, other;
  Field own, field;
  Carry to_field, to_a;
  uint side;
  vec3 drift, twist;
  float margin;
  bool way_back;
  vec3 ahead;
};

void emit(View view, vec3 on_a, vec3 normal, float separation, uint feature) {
  emit(on_a, normal, separation, feature);
}

#include "shared/sphere/touch.h"

Touch touch_of(View view, uint node) {
  Touch touch;
  touch.point = carried(view.to_field, node_at(view.samples, node));
  touch.distance = sample_field(view.field, touch.point, touch.gradient) - radius_of(view.samples);
  return touch;
}

// Of a node (a = b), or of an edge's ends. In a loop: compilers put all that is called in place.
void touches_of(View view, uint a, uint b, out Touch p, out Touch q) {
  p = q = Touch(vec3(0.0), vec3(0.0), 0.0);
  for (uint end = 0u; end < (a == b ? 1u : 2u); ++end) {
    p = q;
    q = touch_of(view, end == 0u ? a : b);
  }
}

// Before the long way: most edges end here.
bool is_worth_testing(View view, uint e) {
  Edge edge = edge_at(view.samples, e);
  Touch p, q;
  touches_of(view, edge.a, edge.b, p, q);
  if (!edge_may_touch(view, edge, p.distance, q.distance)) return false;
  vec3 along = q.point - p.point;
  return dot(p.gradient, along) < 0.0 && dot(q.gradient, along) > 0.0 || may_cross(view, edge, p.distance) ||
         may_cross(view, edge, q.distance);
}

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

// Has the sample wait for the others; false if the queue is full.
bool enqueue(uint feature) {
  uint at = atomicAdd(queued, 1u);
  if (at >= SPHERE_SAMPLE_QUEUE) return false;
  sample_queue[at] = feature;
  return true;
}

const uint NOT_BEGUN = 0xffffffffu;

// Puts the samples of the clusters nearby that are worth testing into the queue, from the k-th cluster on. Stops when
// that is full, to go on from there: edge `e` of cluster k, or its node.
void test_clusters(View view, inout uint k, inout uint e) {
  const uint lane = gl_LocalInvocationIndex % SPHERE_CLUSTER;
  for (; k < near_count; k += SPHERE_PAIR_GROUP / SPHERE_CLUSTER, e = NOT_BEGUN) {
    uint c = near_clusters[k], node = c * SPHERE_CLUSTER + lane;
    uvec4 range = clusters[view.samples.clusters.x + c].edges;
    if (e == NOT_BEGUN) {
      bool holds = node < view.samples.nodes.y;
      if (holds && node_may_touch(view, touch_of(view, node).distance) && !enqueue(node)) return;
      nodes_tested += uint(holds);
      e = range.x + lane;
    }
    for (; e < range.y; e += SPHERE_CLUSTER)
      if (is_worth_testing(view, e) && !enqueue(e | SPHERE_EDGE)) return;
  }
}

// All invocations; the field of the other body is in use.
void test_samples(View view) {
  uint thread = gl_LocalInvocationIndex, count = view.samples.clusters.y;
  float slack = view.margin + radius_of(view.samples) + sag_of(view.samples) + error_of(view.field);
  if (thread == 0u) near_count = queued = 0u;
  barrier();
  for (uint c = thread; c < count; c += SPHERE_PAIR_GROUP) {
    vec4 ball = clusters[view.samples.clusters.x + c].ball;
    ++clusters_tested;
    if (sample_field(view.field, carried(view.to_field, ball.xyz)) <= ball.w + slack)
      near_clusters[atomicAdd(near_count, 1u)] = c;
  }
  barrier();
  uint k = thread / SPHERE_CLUSTER, e = NOT_BEGUN;
  bool full = true;
  while (full) {
    test_clusters(view, k, e);
    barrier();
    full = queued > SPHERE_SAMPLE_QUEUE;
    for (uint q = thread; q < min(queued, SPHERE_SAMPLE_QUEUE); q += SPHERE_PAIR_GROUP) test_sample(view, sample_queue[q]);
    barrier();
    if (thread == 0u) queued = 0u;
    barrier();
  }
}

// How the points of a body go on over another one until the step ends, in the frame of that one.
struct Drift {
  vec3 drift, twist;
};

Drift drift_of(uint points, Placement at, uint over, Placement frame) {
  float rest = time_step - plan.half_way + plan.sub_step;  // the last sweeps look as far ahead as another one
  vec3 v = vec3(0.0), w = vec3(0.0), frame_v = vec3(0.0), frame_w = vec3(0.0);
  vec3 fall = time_step * worlds[world_index].gravity.xyz;
  if (moves(points)) {
    v = states[points].velocity.xyz + fall;
    w = states[points].spin.xyz;
  }
  if (moves(over)) {
    frame_v = states[over].velocity.xyz + fall;
    frame_w = states[over].spin.xyz;
  }
  return Drift(rest * ((v - frame_v + cross(w, frame.position - at.position)) * frame.rotation),
               rest * ((w - frame_w) * frame.rotation));
}

// The samples of each body against the field of the other, in a loop: compilers put all that is called in place, and of
// this there is much.
void test_pair(SpherePair pair, float margin) {
  Placement a = placement_of(pair.a), b = placement_of(pair.b);
  mat3 b_to_a = transpose(a.rotation) * b.rotation, a_to_b = transpose(b_to_a);
  vec3 b_in_a = (b.position - a.position) * a.rotation, a_in_b = -(a_to_b * b_in_a);
  Carry from_a = Carry(a_to_b, a_in_b), from_b = Carry(b_to_a, b_in_a);
  for (uint turn = 0u; turn < 2u; ++turn) {
    bool of_a = turn == 0u;
    uint own = of_a ? pair.a : pair.b, other = of_a ? pair.b : pair.a;
    Placement at = b, frame = a;
    if (of_a) {
      at = a;
      frame = b;
    }
    Drift goes = drift_of(own, at, other, frame);
    View view = View(samples_of(own), samples_of(other), field_of(bodies[own].ids.x), field_of(bodies[other].ids.x),
                     from_b, from_b, of_a ? 0u : SPHERE_SIDE_B, goes.drift, goes.twist, margin, true, vec3(0.0));
    if (of_a) view.to_field = from_a;
    test_samples(view);
    if (gl_LocalInvocationIndex == 0u) count_possible(view.samples.nodes.y);
  }
}

bool within_walls(SphereWorld world, vec3 p, float margin) {
  for (uint k = 0u; k < world.pairs.w; ++k) {
    Plane other = planes[world.pairs.z + k];
    if (is_wall(other) && dot(normal_of(other), p) < offset_of(other) - margin) return true;
  }
  return false;
}

// All invocations, each some places along the rim of plane k.
void test_rim(SphereWorld world, uint k, uint shape, Samples samples, Field field, Placement a, float margin) {
  Plane plane = planes[world.pairs.z + k];
  Rim rim;
  float radius = shapes[shape].box_center.w;
  if (!find_rim(plane, world.ground.z, a.position, radius, margin, face_spacing_of(samples), rim)) return;
  for (int i = rim.first + int(gl_LocalInvocationIndex); i <= rim.last; i += SPHERE_PAIR_GROUP) {
    float before = distance_at(rim, field, a.rotation, i - 1), here = distance_at(rim, field, a.rotation, i);
    float after = distance_at(rim, field, a.rotation, i + 1), t;
    Touch touch;
    if (may_touch_rim(rim, before, here, after, margin) && touch_rim(rim, plane, field, a.rotation, i, t, touch) &&
        touch.distance < margin && !within_walls(world, a.position + rim.start + t * rim.along, margin))
      emit(touch.point - touch.distance * touch.gradient, touch.gradient, touch.distance, rim_feature(i, k));
  }
}

void test_ground(SpherePair pair, float margin) {
  uint thread = gl_LocalInvocationIndex, shape = bodies[pair.a].ids.x;
  SphereWorld world = worlds[world_index];
  Placement a = placement_of(pair.a);
  Carry carry = Carry(a.rotation, a.position);
  Samples samples = samples_of(pair.a);
  Field own = field_of(shape);
  for (uint k = 0u; k < world.pairs.w; ++k) {
    Plane plane = planes[world.pairs.z + k];
    test_rim(world, k, shape, samples, own, a, margin);
    Solid solid = Solid(true, own, plane, world.ground.z);
    float far = radius_of(samples) + sag_of(samples) + margin;
    if (dot(normal_of(plane), a.position) - offset_of(plane) > shapes[shape].box_center.w + far) continue;
    for (uint c = thread / SPHERE_CLUSTER; c < samples.clusters.y; c += SPHERE_PAIR_GROUP / SPHERE_CLUSTER) {
      vec4 ball = clusters[samples.clusters.x + c].ball;
      if (thread % SPHERE_CLUSTER == 0u) ++clusters_tested;
      if (dot(normal_of(plane), carried(carry, ball.xyz)) - offset_of(plane) > ball.w + far) continue;
      uint node = c * SPHERE_CLUSTER + thread % SPHERE_CLUSTER;
      if (node >= samples.nodes.y) continue;
      ++nodes_tested;
      Touch touch;
      touch.point = carried(carry, node_at(samples, node));
      touch.distance = distance_to(solid, touch.point, touch.gradient) - radius_of(samples);
      if (touch.distance > margin + sag_of(samples)) continue;
      slide(samples, own, carry, node, solid, touch);
      vec3 surface = touch.point - a.position - radius_of(samples) * touch.gradient;
      if (touch.distance > margin) continue;
      emit(turned_back(a.rotation, surface), -turned_back(a.rotation, touch.gradient), touch.distance,
           node + k * SPHERE_PLANE);
    }
  }
  if (thread == 0u) count_possible(samples.nodes.y);
}

void main() {
  take_room();
  for (uint n = 0u; n < SPHERE_GROUP_JOBS; ++n) {
    if (gl_LocalInvocationIndex == 0u) job = atomicAdd(status.next_job, 1u);
    barrier();
    if (job >= status.jobs) break;
    SpherePair pair = pairs[jobs[job]];
    world_index = bodies[pair.a].ids.y;
    SphereWorld world = worlds[world_index];
    clusters_tested = nodes_tested = 0u;
    begin_candidates(world, pair.slot);
    time_step = progress[world_index].time_step;
    plan = plan_of(world_index);
    float margin = settings.margin * size_of(pair) + way_of(world, pair);
    if (pair.b == SPHERE_GROUND)
      test_ground(pair, margin);
    else
      test_pair(pair, margin);
    finish_candidates(world, pair);
    atomicAdd(progress[world_index].clusters_tested, clusters_tested);
    atomicAdd(progress[world_index].nodes_tested, nodes_tested);
  }
  leave_room();
}
