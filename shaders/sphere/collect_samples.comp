// A group takes one pair after the other from the list of jobs: which samples of each body are near the other, bounding
// spheres first. They wait for test_samples; what touches the bin's walls and floor is a candidate at once. Twin:
// test_samples(), candidates_of_ground().
#include "shared/sphere.h"
#include "shared/dispatch.h"

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
layout(std430, binding = BIND_FIELDS) readonly buffer Fields { vec4 fields[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_CANDIDATES) buffer Candidates { SphereCandidate candidates[]; };
layout(std430, binding = BIND_SAMPLES) writeonly buffer NearSamples { SphereSample samples[]; };

#include "sphere/sample_view.h"
#include "shared/sphere/rim.h"

uint clusters_tested, nodes_tested;

shared uint job_taken;
shared uint near_clusters[SPHERE_MAX_CLUSTERS], near_count;

// Nodes of the clusters at hand, one an invocation, in the field's frame: edges that end there read them.
shared vec3 node_point[SPHERE_PAIR_GROUP], node_gradient[SPHERE_PAIR_GROUP];
shared float node_distance[SPHERE_PAIR_GROUP];

Touch held_node(uint slot) { return Touch(node_point[slot], node_gradient[slot], node_distance[slot]); }

// Rejects most edges before test_samples. The edge starts in the cluster at hand, whose node number `first` is held at
// `slot`.
bool is_worth_testing(View view, uint e, uint first, uint slot) {
  Edge edge = edge_at(view.samples, e);
  Touch p = held_node(slot + edge.a - first), q;
  // By the distance of one end, before that of the other is looked up in another cluster.
  if (p.distance - length_of(edge) >= view.margin + error_of(view.field)) return false;
  if (edge.b - first < SPHERE_CLUSTER)
    q = held_node(slot + edge.b - first);
  else
    q = touch_of(view, edge.b);
  if (!edge_may_touch(view, edge, p.distance, q.distance)) return false;
  vec3 along = q.point - p.point;
  return dot(p.gradient, along) < 0.0 && dot(q.gradient, along) > 0.0 || may_cross(view, edge, p.distance) ||
         may_cross(view, edge, q.distance);
}

// Has the sample wait for test_samples.
void collect(View view, uint feature) {
  uint at = atomicAdd(status.samples, 1u);
  if (at >= settings.samples) {
    atomicOr(progress[world_index].overflow, SPHERE_SAMPLE_OVERFLOW);
    atomicMax(progress[world_index].need, at + 1u);
    jobs[job].incomplete = 1u;
    return;
  }
  samples[at] = SphereSample(job, feature | view.side);
  if (at % SPHERE_PAIR_GROUP != 0u) return;
  uvec3 groups = folded_groups(at / SPHERE_PAIR_GROUP + 1u);
  atomicMax(status.sample_groups.x, groups.x);
  atomicMax(status.sample_groups.y, groups.y);
}

// The samples of clusters nearby that are worth testing, SPHERE_PAIR_GROUP / SPHERE_CLUSTER clusters at a time, from
// number `from` of near_clusters on; each invocation of a cluster has a node and every SPHERE_CLUSTER-th edge.
void collect_from(View view, uint from) {
  uint thread = gl_LocalInvocationIndex, lane = thread % SPHERE_CLUSTER, k = from + thread / SPHERE_CLUSTER;
  bool has_cluster = k < near_count;
  uint c = has_cluster ? near_clusters[k] : 0u, first = c * SPHERE_CLUSTER, node = first + lane;
  if (has_cluster && node < view.samples.nodes.y) {
    ++nodes_tested;
    Touch touch = touch_of(view, node);
    node_point[thread] = touch.point;
    node_gradient[thread] = touch.gradient;
    node_distance[thread] = touch.distance;
    if (node_may_touch(view, touch.distance)) collect(view, node);
  }
  barrier();
  uvec4 range = uvec4(0u);
  if (has_cluster) range = clusters[view.samples.clusters.x + c].edges;
  for (uint e = range.x + lane; e < range.y; e += SPHERE_CLUSTER)
    if (is_worth_testing(view, e, first, thread - lane)) collect(view, e | SPHERE_EDGE);
  barrier();
}

// 64-bit sum, for what a big world counts beyond 2^32 between two observations.
void count_possible(uint n) {
  uint before = atomicAdd(progress[world_index].nodes_possible, n);
  if (before + n < before) atomicAdd(progress[world_index].nodes_possible_high, 1u);
}

// All invocations; the field of the other body is in use.
void collect_samples(View view) {
  uint thread = gl_LocalInvocationIndex;
  float slack = view.margin + radius_of(view.samples) + sag_of(view.samples) + error_of(view.field);
  if (thread == 0u) near_count = 0u;
  barrier();
  for (uint c = thread; c < view.samples.clusters.y; c += SPHERE_PAIR_GROUP) {
    vec4 ball = clusters[view.samples.clusters.x + c].ball;
    ++clusters_tested;
    if (sample_field(view.field, carried(view.to_field, ball.xyz)) <= ball.w + slack)
      near_clusters[atomicAdd(near_count, 1u)] = c;
  }
  barrier();
  for (uint from = 0u; from < near_count; from += SPHERE_PAIR_GROUP / SPHERE_CLUSTER) collect_from(view, from);
  barrier();  // all know how many there were
  if (thread == 0u) count_possible(view.samples.nodes.y);
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
  for (uint n = 0u; n < SPHERE_GROUP_JOBS; ++n) {
    if (gl_LocalInvocationIndex == 0u) job_taken = atomicAdd(status.next_job, 1u);
    barrier();
    job = job_taken;
    if (job >= status.jobs) break;
    SpherePair pair = pairs[jobs[job].pair];
    take_world_of(pair);
    clusters_tested = nodes_tested = 0u;
    float margin = margin_of(pair);
    if (pair.b == SPHERE_GROUND) {
      test_ground(pair, margin);
      barrier();  // all know of this job
    } else {  // in a loop: compilers put all that is called in place
      Placement a = placement_of(pair.a), b = placement_of(pair.b);
      for (uint turn = 0u; turn < 2u; ++turn) collect_samples(view_of(pair, a, b, turn == 0u, margin));
    }
    atomicAdd(progress[world_index].clusters_tested, clusters_tested);
    atomicAdd(progress[world_index].nodes_tested, nodes_tested);
  }
}
