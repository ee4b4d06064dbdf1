// A group takes some pairs at a time from the list of jobs: which samples of each body are near the other, bounding
// spheres first. They wait for test_samples; what touches the bin's walls and floor is a candidate at once. Clusters,
// nodes and edges of all pairs at hand wait in lists, so that each invocation has one. Twin: test_samples(),
// candidates_of_ground().
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
layout(std430, binding = BIND_FIELDS) readonly buffer Fields { vec2 fields[]; };
layout(std430, binding = BIND_PAIRS) readonly buffer Pairs { SpherePair pairs[]; };
layout(std430, binding = BIND_JOBS) buffer Jobs { SphereStatus status; SphereJob jobs[]; };
layout(std430, binding = BIND_CANDIDATES) buffer Candidates { SphereCandidate candidates[]; };
layout(std430, binding = BIND_SAMPLES) writeonly buffer NearSamples { SphereSample samples[]; };

#include "sphere/sample_view.h"
#include "shared/sphere/rim.h"
#include "sphere/sample_kinds.h"

const uint LEAST_JOBS = 4u, MOST_JOBS = min(SPHERE_PAIR_GROUP / 2u, SPHERE_GROUP_JOBS);  // at a time
const uint AT_ONCE = SPHERE_PAIR_GROUP / SPHERE_CLUSTER;                                 // clusters at a time
const uint MOST_NEAR = 256u, MOST_WAITING = 2u * SPHERE_PAIR_GROUP, MOST_FOUND = 256u;   // room in lists

// The samples of one body of a job against the field of the other: what this pass needs of a View.
struct Side {
  vec4 to_field[3];  // column of the rotation, offset
  vec4 origin;       // of the field's grid; 1 / cell
  vec4 most;         // largest grid coordinate; radius of a ball
  uvec4 grid;        // row, slice, and first element of the field; job, with SPHERE_SIDE_B
  uvec4 samples;     // first node, number of nodes, first edge, first cluster
  vec4 sizes;        // cell, padding, radius of the nodes, margin
  float sag;
  float movement;    // largest predicted movement of a sample in this step (m)
  uint clusters;     // 0 for the ground
};

shared uint first_job;
shared Side sides[2u * MOST_JOBS];                 // two of each job at hand
shared uint nodes_near[2u * MOST_JOBS];            // nodes of the clusters nearby
shared uint near_clusters[MOST_NEAR], near_count;  // side << 16 | cluster

// Nodes of the clusters at hand, one an invocation: edges that start there read them.
shared vec4 node_point[SPHERE_PAIR_GROUP], node_gradient[SPHERE_PAIR_GROUP];  // w: distance; none

// Edges whose other end is still to be tested: side and edge; the first end.
shared uvec2 waiting[MOST_WAITING];
shared vec4 waiting_point[MOST_WAITING], waiting_gradient[MOST_WAITING];
shared uint waiting_count;

shared uvec2 found[MOST_FOUND];  // samples: side << 16 | kind; feature
shared uint found_count;

View view_at(uint s) {
  Side side = sides[s];
  Field field = Field(side.origin.xyz, side.most.xyz, side.sizes.x, side.origin.w, side.sizes.y, side.most.w,
                      side.grid.x, side.grid.y, side.grid.z);
  Samples samples = Samples(uvec4(side.samples.xyz, 0u), uvec4(side.samples.w, side.clusters, 0u, 0u), uvec4(0u),
                            vec4(side.sizes.z, 0.0, 0.0, side.sag));
  vec4 x = side.to_field[0], y = side.to_field[1], z = side.to_field[2];
  Carry to_field = Carry(mat3(x.xyz, y.xyz, z.xyz), vec3(x.w, y.w, z.w));
  return View(samples, samples, field, field, to_field, to_field, side.grid.w & SPHERE_SIDE_B, vec3(0.0), vec3(0.0),
              side.sizes.w, 0.0, true);
}

// 64-bit sum, for what a big world counts beyond 2^32 between two observations.
void count_possible(uint n) {
  uint before = atomicAdd(progress[world_index].nodes_possible, n);
  if (before + n < before) atomicAdd(progress[world_index].nodes_possible_high, 1u);
}

bool is_of_ground(uint of_job) { return pairs[jobs[of_job].pair].b == SPHERE_GROUND; }

// An invocation a side.
void hold_side(uint s, uint of_job) {
  SpherePair pair = pairs[jobs[of_job].pair];
  nodes_near[s] = sides[s].clusters = 0u;
  if (pair.b == SPHERE_GROUND) return;
  take_world_of(pair);
  bool of_a = s % 2u == 0u;
  View view = view_of(pair, placement_of(pair.a), placement_of(pair.b), of_a, margin_of(pair));
  Field field = view.field;
  mat3 turn = view.to_field.rotation;
  vec3 offset = view.to_field.offset;
  Samples own = view.samples;
  sides[s].to_field[0] = vec4(turn[0], offset.x);
  sides[s].to_field[1] = vec4(turn[1], offset.y);
  sides[s].to_field[2] = vec4(turn[2], offset.z);
  sides[s].origin = vec4(field.origin, field.inverse_cell);
  sides[s].most = vec4(field.most, field.ball);
  sides[s].grid = uvec4(field.row, field.slice, field.first, of_job | view.side);
  sides[s].samples = uvec4(own.nodes.xyz, own.clusters.x);
  sides[s].sizes = vec4(field.cell, field.padding, radius_of(own), view.margin);
  sides[s].sag = sag_of(own);
  float radius = shapes[bodies[of_a ? pair.a : pair.b].ids.x].box_center.w;
  sides[s].movement = length(view.drift) + length(view.twist) * (length(offset) + radius);
  sides[s].clusters = own.clusters.y;
  atomicAdd(progress[world_index].clusters_tested, own.clusters.y);
  count_possible(own.nodes.y);
}

// Has a sample wait for test_samples.
void pass_on(uint s, uint feature, uint kind) {
  uint of = sides[s].grid.w, at = atomicAdd(status.samples, 1u);
  if (at >= settings.samples) {
    uint of_job = of & ~SPHERE_SIDE_B, world = bodies[pairs[jobs[of_job].pair].a].ids.y;
    atomicOr(progress[world].overflow, SPHERE_SAMPLE_OVERFLOW);
    atomicMax(progress[world].need, at + 1u);
    jobs[of_job].incomplete = 1u;
    return;
  }
  uint of_kind = atomicAdd(status.sample_kinds[kind], 1u);
  samples[place_of_sample(kind, of_kind)] = SphereSample(of & ~SPHERE_SIDE_B, feature | of & SPHERE_SIDE_B);
  if (of_kind % SPHERE_PAIR_GROUP != 0u) return;
  uvec3 groups = folded_groups(1u + atomicAdd(status.sample_blocks, 1u));
  atomicMax(status.sample_groups.x, groups.x);
  atomicMax(status.sample_groups.y, groups.y);
}

// The same, later.
void collect(uint s, uint feature, uint kind) {
  uint at = atomicAdd(found_count, 1u);
  if (at < MOST_FOUND)
    found[at] = uvec2(s << 16 | kind, feature);
  else
    pass_on(s, feature, kind);
}

// All invocations, SPHERE_CLUSTER for each of AT_ONCE sides: lists clusters nearby, from cluster c of side s on. Ends
// early if the list is full.
void list_clusters(uint count, inout uint s, inout uint c) {
  for (; s < count; s += AT_ONCE) {
    if (sides[s].clusters == 0u) continue;
    View view = view_at(s);
    float slack = view.margin + radius_of(view.samples) + sag_of(view.samples) + error_of(view.field);
    for (; c < view.samples.clusters.y; c += SPHERE_CLUSTER) {
      vec4 ball = clusters[view.samples.clusters.x + c].ball;
      if (sample_field(view.field, carried(view.to_field, ball.xyz)) > ball.w + slack) continue;
      uint at = atomicAdd(near_count, 1u);
      if (at >= MOST_NEAR) return;
      near_clusters[at] = s << 16 | c;
      atomicAdd(nodes_near[s], min(SPHERE_CLUSTER, view.samples.nodes.y - c * SPHERE_CLUSTER));
    }
    c = gl_LocalInvocationIndex % SPHERE_CLUSTER;
  }
}

// Rejects most of the edges that wait.
void test_waiting(uint at) {
  uint s = waiting[at].x, e = waiting[at].y;
  View view = view_at(s);
  Edge edge = edge_at(view.samples, e);
  vec4 point = waiting_point[at];
  vec3 gradient = waiting_gradient[at].xyz;
  Touch q = touch_of(view, edge.b);
  vec3 along = q.point - point.xyz;
  if (!edge_may_touch(view, edge, point.w, q.distance)) return;
  bool descends = dot(gradient, along) < 0.0 && dot(q.gradient, along) > 0.0;
  if (descends || may_cross(view, edge, point.w) || may_cross(view, edge, q.distance) ||
      may_arrive(view, edge, point.w, q.distance, sides[s].movement))
    collect(s, e | SPHERE_EDGE, descends ? SPHERE_SAMPLE_DESCENDS : SPHERE_SAMPLE_CROSSES);
}

// Lists edges with a first end, at `first_end`, that is near enough, from edge e on. Ends early if the list is full.
void list_edges(View view, uint s, uint first_end, uint end, inout uint e) {
  for (; e < end; e += SPHERE_CLUSTER) {
    Edge edge = edge_at(view.samples, e);
    vec4 point = node_point[first_end + edge.a];
    if (point.w - length_of(edge) >= view.margin + error_of(view.field)) continue;
    uint at = atomicAdd(waiting_count, 1u);
    if (at >= MOST_WAITING) return;
    waiting[at] = uvec2(s, e);
    waiting_point[at] = point;
    waiting_gradient[at] = node_gradient[first_end + edge.a];
  }
}

// All invocations, SPHERE_CLUSTER for each of AT_ONCE clusters nearby, from number `from` of `count` on: each has a
// node, and every SPHERE_CLUSTER-th edge that starts in the cluster. `last`: no edge is left waiting.
void collect_from(uint from, uint count, bool last) {
  uint thread = gl_LocalInvocationIndex, lane = thread % SPHERE_CLUSTER, k = from + thread / SPHERE_CLUSTER;
  uint near = near_clusters[min(k, count - 1u)], s = near >> 16, c = near & 0xffffu, node = c * SPHERE_CLUSTER + lane;
  View view = view_at(s);
  uvec2 range = uvec2(0u);
  if (k < count) range = clusters[view.samples.clusters.x + c].edges.xy;
  if (k < count && node < view.samples.nodes.y) {
    Touch touch = touch_of(view, node);
    node_point[thread] = vec4(touch.point, touch.distance);
    node_gradient[thread] = vec4(touch.gradient, 0.0);
    if (node_may_touch(view, touch.distance)) {
      bool slides = bounds_of(cone_at(view.samples, node)) == SPHERE_AXIS;
      collect(s, node, slides ? SPHERE_SAMPLE_SLIDES : SPHERE_SAMPLE_RESTS);
    }
  }
  uint e = range.x + lane, waits = MOST_WAITING + 1u;
  while (waits > MOST_WAITING) {
    barrier();
    list_edges(view, s, thread - node, range.y, e);
    barrier();
    waits = waiting_count;
    uint left = min(waits, MOST_WAITING), least = last || left < waits ? 1u : SPHERE_PAIR_GROUP;
    if (left < least) break;
    for (; left >= least; left -= min(left, SPHERE_PAIR_GROUP))
      if (thread < left) test_waiting(left - 1u - thread);
    barrier();
    if (thread == 0u) waiting_count = left;
  }
}

// All invocations: the samples of the sides at hand that are near the other body, and worth testing. Each kind of work
// waits until there is some for all invocations.
void collect_samples(uint count) {
  uint thread = gl_LocalInvocationIndex, s = thread / SPHERE_CLUSTER, c = thread % SPHERE_CLUSTER;
  uint nearby = MOST_NEAR + 1u;
  while (nearby > MOST_NEAR) {
    barrier();
    list_clusters(count, s, c);
    barrier();
    nearby = near_count;
    uint near = min(nearby, MOST_NEAR);
    for (uint k = 0u; k < near; k += AT_ONCE) collect_from(k, near, k + AT_ONCE >= near);
    if (thread == 0u && nearby > MOST_NEAR) near_count = 0u;
  }
  for (uint i = thread; i < min(found_count, MOST_FOUND); i += SPHERE_PAIR_GROUP)
    pass_on(found[i].x >> 16, found[i].y, found[i].x & 0xffffu);
}

bool within_walls(SphereWorld world, vec3 p, float margin) {
  for (uint k = 0u; k < world.pairs.w; ++k) {
    Plane other = planes[world.pairs.z + k];
    if (is_wall(other) && dot(normal_of(other), p) < offset_of(other) - margin) return true;
  }
  return false;
}

void offer_rim(SphereWorld world, Touch touch, vec3 place, float margin, uint feature) {
  if (touch.distance < margin && !within_walls(world, place, margin))
    emit(touch.point - touch.distance * touch.gradient, touch.gradient, touch.distance, feature);
}

// All invocations, each some places along the rim of plane k.
void test_rim(SphereWorld world, uint k, uint shape, Samples samples, Field field, Placement a, float margin) {
  Plane plane = planes[world.pairs.z + k];
  Rim rim;
  float radius = shapes[shape].box_center.w;
  if (!find_rim(plane, world.ground.z, a.position, radius, margin, face_spacing_of(samples), rim)) return;
  vec3 start = a.position + rim.start;
  for (int i = rim.first + int(gl_LocalInvocationIndex); i <= rim.last; i += SPHERE_PAIR_GROUP) {
    float before = distance_at(rim, field, a.rotation, i - 1), here = distance_at(rim, field, a.rotation, i);
    float after = distance_at(rim, field, a.rotation, i + 1), t;
    Touch touch;
    if (!may_touch_rim(rim, before, here, after, margin) || !touch_rim(rim, plane, field, a.rotation, i, t, touch) ||
        touch.distance >= margin)
      continue;
    offer_rim(world, touch, start + t * rim.along, margin, rim_feature(i, false, k));
    if (touch_far_end(rim, field, a.rotation, t, touch))
      offer_rim(world, touch, start + t * rim.along, margin, rim_feature(i, true, k));
  }
}

// All invocations.
void test_ground(uint of_job) {
  job = of_job;
  SpherePair pair = pairs[jobs[job].pair];
  take_world_of(pair);
  float margin = margin_of(pair);
  uint thread = gl_LocalInvocationIndex, shape = bodies[pair.a].ids.x, clusters_tested = 0u, nodes_tested = 0u;
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
  if (clusters_tested > 0u) atomicAdd(progress[world_index].clusters_tested, clusters_tested);
  if (nodes_tested > 0u) atomicAdd(progress[world_index].nodes_tested, nodes_tested);
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint at_once = clamp(status.jobs / settings.contact_groups, LEAST_JOBS, MOST_JOBS);
  for (uint n = 0u; n < SPHERE_GROUP_JOBS; n += at_once) {
    if (thread == 0u) {
      first_job = atomicAdd(status.next_job, at_once);
      near_count = waiting_count = found_count = 0u;
    }
    barrier();
    uint first = first_job;
    if (first >= status.jobs) break;
    uint count = min(at_once, status.jobs - first);
    if (thread < 2u * count) hold_side(thread, first + thread / 2u);
    collect_samples(2u * count);
    if (thread < 2u * count && nodes_near[thread] > 0u)
      atomicAdd(progress[bodies[pairs[jobs[first + thread / 2u].pair].a].ids.y].nodes_tested, nodes_near[thread]);
    for (uint k = 0u; k < count; ++k)
      if (is_of_ground(first + k)) test_ground(first + k);
    barrier();
  }
}
