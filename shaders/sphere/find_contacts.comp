// A group takes one pair after the other from the list of jobs: samples of each body against the field of the other,
// bounding spheres first, edges by descent, then the few contacts that stand for all, with the forces of the last
// step. An invocation keeps the candidates it finds; choices go by depth and spread, ties by feature, so that neither
// the order of arrival nor who tested what matters. Twin: find_contacts().
#include "shared/sphere.h"

layout(local_size_x = SPHERE_GROUP) in;

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
#include "sphere/edge.h"
#include "sphere/cone.h"
#include "sphere/solid.h"
#include "sphere/slide.h"
#include "sphere/placement.h"

uint world_index, clusters_tested, nodes_tested;

SphereSamples samples_of(uint body) {
  uint shape = bodies[body].ids.x;
  if (progress[world_index].fine != 0u) return shapes[shape].fine;
  return shapes[shape].coarse;
}

// Of a body of this world.
Placement placement_of(uint body) {
  float sub_steps = float(settings.sub_steps * progress[world_index].refinement);
  return placement_of(body, half_way(time_step, time_step / sub_steps));
}

#include "sphere/contact_place.h"
#include "sphere/reduce.h"
#include "sphere/rim.h"

shared uint job;
shared uint near_clusters[SPHERE_MAX_CLUSTERS], near_count;
shared uint edge_queue[SPHERE_EDGE_QUEUE], queued;

const float NEARLY_ALL = 0.99;  // of an exact way out a cone must leave: 8 degrees
const float LEANS = 0.02;       // sine of the angle by which a face leans against an edge that dips below it
const SpherePlane NO_PLANE = SpherePlane(vec4(0.0), uvec4(0u));

// Where the samples of one body lie in the frame of the field, and what is found there in the frame of a.
struct View {
  mat3 to_field, to_a;
  vec3 field_offset, a_offset;
  SphereSamples samples, other;
  Field own, field;
  uint side;
  float margin;
};

// Of the grid where it bends (m).
float error_of(Field field) {
  return field.ball > 0.0 ? 0.0 : 0.5 * field.cell;
}

vec3 carry(View view, uint node) {
  return view.to_field * nodes[view.samples.nodes.x + node].place + view.field_offset;
}

void emit_from(View view, vec3 point, vec3 gradient, float distance, uint feature) {
  vec3 surface = point - view.samples.size.x * gradient;
  if (view.side == 0u)
    emit(view.to_a * surface + view.a_offset, -(view.to_a * gradient), distance, feature);
  else
    emit(surface - distance * gradient, gradient, distance, feature | view.side);
}

// A candidate, if its own surface can be pressed against the way out of the other: `least` of it must be left.
bool press(View view, vec3 point, vec3 away, float distance, uint cone, uint feature, float least) {
  vec3 pressed = -(away * view.to_field);
  if (!turn_into_cone(cone, view.samples.nodes.x, pressed, least)) return false;
  emit_from(view, point, -(view.to_field * pressed), distance, feature);
  return true;
}

// A face that leans against an edge of the sample is not what it presses where that crosses an edge of the face: it
// presses along the normal of both edges, and two such nodes, one on each, would hold each other like a wedge.
bool is_crossed(View view, vec3 point, uint cone, vec3 away) {
  uint bounds = cone & 7u;
  if (bounds == SPHERE_AXIS) return false;
  for (uint i = 0u; i < bounds; ++i) {
    vec3 along = view.to_field * nodes[view.samples.nodes.x + (cone >> 3) + i].place, normal;
    if (dot(along, away) > -LEANS || !passes_edge(view.other, view.field, point, along, away, normal)) continue;
    vec3 pressed = -(normal * view.to_field);
    if (turn_into_cone(cone, view.samples.nodes.x, pressed, NEARLY_ALL)) return true;
  }
  return false;
}

// Near a sharp edge ways out are exact: what presses against none of them does not press there.
bool offer_at_edge(View view, vec3 point, uint cone, uint feature) {
  // Which of two faces it presses against is not known.
  if (view.samples.size.x > 0.0 || (cone & 7u) == 0u) return false;
  vec4 ways[SPHERE_MAX_WAYS];
  uint count = ways_out_at_edge(view.other, view.field, point, ways);
  bool out_there = false;
  for (uint i = 0u; i < count; ++i) {
    vec3 beyond = point + (0.5 * view.field.cell - ways[i].w) * ways[i].xyz;
    if (sample_field(view.field, beyond) < 0.3 * view.field.cell) continue;  // a seam between shells that touch
    out_there = true;
    vec3 pressed = -(ways[i].xyz * view.to_field);
    if (!turn_into_cone(cone, view.samples.nodes.x, pressed, NEARLY_ALL)) continue;
    if (is_crossed(view, point, cone, ways[i].xyz)) continue;
    emit_from(view, point, -(view.to_field * pressed), ways[i].w, feature);
    break;
  }
  return out_there;
}

// A sample that is inside, or as good as, and whose surface cannot be pressed against the nearest way out: of parts that
// lie flush (two plates side by side on the floor) that is the face level with it, although it is deeper in behind
// another. It goes back through its own body, along the middle of its cone, to the face it comes out of: for at most
// four cells, or, deep inside, unless it would be out sooner the other way, for then it did not come in through that
// face.
void offer_back(View view, vec3 point, float distance, uint cone, uint feature) {
  bool deep = distance < -2.0 * view.field.cell;
  vec3 back = -(view.to_field * middle_of_cone(cone, view.samples.nodes.x));
  float way = way_out(view.field, point, back, distance, deep ? span(view.field) : 4.0 * view.field.cell);
  if (way < 0.0) return;
  if (deep) {
    float ahead = way_out(view.field, point, -back, distance, way);
    if (ahead >= 0.0 && ahead < way) return;
  }
  vec3 away;
  sample_field(view.field, point + way * back, away);
  float behind = -way * dot(back, away);
  if (behind <= 0.0) press(view, point, away, behind, cone, feature, LEAST_LEFT);
}

void offer(View view, vec3 point, vec3 away, float distance, uint cone, uint feature) {
  if (offer_at_edge(view, point, cone, feature)) return;
  if (press(view, point, away, distance, cone, feature, LEAST_LEFT)) return;
  if (distance < error_of(view.field)) offer_back(view, point, distance, cone, feature);
}

void test_node(View view, uint node) {
  vec3 point = carry(view, node), gradient;
  float distance = sample_field(view.field, point, gradient) - view.samples.size.x;
  ++nodes_tested;
  if (distance >= view.margin + view.samples.size.w) return;
  Solid other = Solid(false, view.field, NO_PLANE, 0.0);
  slide(view.samples, view.own, view.to_field, view.field_offset, node, other, point, gradient, distance);
  if (distance < view.margin)
    offer(view, point, gradient, distance, nodes[view.samples.nodes.x + node].cone, node);
}

// Where edges are nearly parallel, or end, one dips below the other by less than the grid can tell.
bool may_cross(View view, uvec4 ends, float distance) {
  return uintBitsToFloat(ends.w) > 0.0 && view.samples.size.x == 0.0 && abs(distance) <= view.field.cell;
}

bool edge_may_touch(View view, uint edge) {
  uvec4 ends = edges[view.samples.nodes.z + edge];
  vec3 p = carry(view, ends.x), q = carry(view, ends.y), gradient_p, gradient_q;
  float distance_p = sample_field(view.field, p, gradient_p), distance_q = sample_field(view.field, q, gradient_q);
  // A distance falls by no more than the way.
  if (0.5 * (distance_p + distance_q - 2.0 * view.samples.size.x - abs(uintBitsToFloat(ends.w))) >= view.margin) return false;
  return dot(gradient_p, q - p) < 0.0 && dot(gradient_q, q - p) > 0.0 || may_cross(view, ends, distance_p) ||
         may_cross(view, ends, distance_q);
}

void test_edge(View view, uint edge) {
  uvec4 ends = edges[view.samples.nodes.z + edge];
  vec3 p = carry(view, ends.x), q = carry(view, ends.y), point, gradient;
  float distance;
  if (descend(view.field, p, q, view.samples.size.x, point, gradient, distance)) {
    bool crossed = cross_edges(view.other, view.field, p, q, point, gradient, distance);
    if (distance >= view.margin) return;
    if (!crossed || !press(view, point, gradient, distance, ends.z, edge | SPHERE_EDGE, LEAST_LEFT))
      offer(view, point, gradient, distance, ends.z, edge | SPHERE_EDGE);
    return;
  }
  for (uint end = 0u; end < 2u; ++end) {
    point = end == 0u ? p : q;
    distance = sample_field(view.field, point, gradient);
    if (!may_cross(view, ends, distance)) continue;
    if (!cross_edges(view.other, view.field, p, q, point, gradient, distance)) continue;
    if (distance < view.margin) press(view, point, gradient, distance, ends.z, edge | SPHERE_EDGE, NEARLY_ALL);
    return;
  }
}

// All invocations; the field of the other body is in use.
void test_samples(View view) {
  uint thread = gl_LocalInvocationIndex, count = view.samples.clusters.y;
  float slack = view.margin + view.samples.size.x + view.samples.size.w + error_of(view.field);
  if (thread == 0u) near_count = queued = 0u;
  barrier();
  for (uint c = thread; c < count; c += SPHERE_GROUP) {
    vec4 ball = clusters[view.samples.clusters.x + c].ball;
    ++clusters_tested;
    if (sample_field(view.field, view.to_field * ball.xyz + view.field_offset) <= ball.w + slack)
      near_clusters[atomicAdd(near_count, 1u)] = c;
  }
  barrier();
  const uint lane = thread % SPHERE_CLUSTER;
  for (uint k = thread / SPHERE_CLUSTER; k < near_count; k += SPHERE_GROUP / SPHERE_CLUSTER) {
    uint c = near_clusters[k], node = c * SPHERE_CLUSTER + lane;
    if (node < view.samples.nodes.y) test_node(view, node);
    uvec4 range = clusters[view.samples.clusters.x + c].edges;
    for (uint e = range.x + lane; e < range.y; e += SPHERE_CLUSTER) {
      if (!edge_may_touch(view, e)) continue;
      uint at = atomicAdd(queued, 1u);
      if (at < SPHERE_EDGE_QUEUE)
        edge_queue[at] = e;
      else
        test_edge(view, e);
    }
  }
  barrier();
  for (uint k = thread; k < min(queued, SPHERE_EDGE_QUEUE); k += SPHERE_GROUP) test_edge(view, edge_queue[k]);
  barrier();
}

void test_pair(SpherePair pair, float margin) {
  uint shape_a = bodies[pair.a].ids.x, shape_b = bodies[pair.b].ids.x;
  Placement a = placement_of(pair.a), b = placement_of(pair.b);
  mat3 b_to_a = transpose(a.rotation) * b.rotation, a_to_b = transpose(b_to_a);
  vec3 b_in_a = (b.position - a.position) * a.rotation, a_in_b = -(a_to_b * b_in_a);
  SphereSamples samples_a = samples_of(pair.a), samples_b = samples_of(pair.b);
  Field field_a = field_of(shape_a), field_b = field_of(shape_b);
  test_samples(View(a_to_b, b_to_a, a_in_b, b_in_a, samples_a, samples_b, field_a, field_b, 0u, margin));
  test_samples(View(b_to_a, b_to_a, b_in_a, b_in_a, samples_b, samples_a, field_b, field_a, SPHERE_SIDE_B, margin));
  if (gl_LocalInvocationIndex == 0u) count_possible(samples_a.nodes.y + samples_b.nodes.y);
}

void test_ground(SpherePair pair, float margin) {
  uint thread = gl_LocalInvocationIndex, shape = bodies[pair.a].ids.x;
  SphereWorld world = worlds[world_index];
  Placement a = placement_of(pair.a);
  mat3 ra = a.rotation;
  vec3 position = a.position;
  SphereSamples samples = samples_of(pair.a);
  Field own = field_of(shape);
  for (uint k = 0u; k < world.pairs.w; ++k) {
    SpherePlane plane = planes[world.pairs.z + k];
    test_rim(world, k, shapes[shape].box_center.w, samples, own, ra, position, margin);
    float far = samples.size.x + samples.size.w + margin;
    if (dot(plane.plane.xyz, position) - plane.plane.w > shapes[shape].box_center.w + far) continue;
    for (uint c = thread / SPHERE_CLUSTER; c < samples.clusters.y; c += SPHERE_GROUP / SPHERE_CLUSTER) {
      vec4 ball = clusters[samples.clusters.x + c].ball;
      if (thread % SPHERE_CLUSTER == 0u) ++clusters_tested;
      if (dot(plane.plane.xyz, position + ra * ball.xyz) - plane.plane.w > ball.w + far) continue;
      uint node = c * SPHERE_CLUSTER + thread % SPHERE_CLUSTER;
      if (node >= samples.nodes.y) continue;
      ++nodes_tested;
      vec3 arm = ra * nodes[samples.nodes.x + node].place, away;
      vec3 point = position + arm;
      float distance = plane_distance(plane, world.ground.z, point, away) - samples.size.x;
      if (distance > margin + samples.size.w) continue;
      slide(samples, own, ra, position, node, Solid(true, own, plane, world.ground.z), point, away, distance);
      arm = point - position;
      if (distance <= margin)
        emit((arm - samples.size.x * away) * ra, -(away * ra), distance, node + k * SPHERE_PLANE);
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
    float margin = settings.margin * size_of(pair) + way_of(world, pair);
    if (pair.b == SPHERE_GROUND)
      test_ground(pair, margin);
    else
      test_pair(pair, margin);
    finish_candidates(world, pair);
    atomicAdd(progress[world_index].clusters_tested, clusters_tested);
    atomicAdd(progress[world_index].nodes_tested, nodes_tested);
    barrier();  // shared memory is free for the next pair
  }
  leave_room();
}
