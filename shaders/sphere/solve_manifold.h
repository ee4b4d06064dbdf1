// Manifolds in the solve: what one invocation does with one of them. Whoever includes this says where velocities lie:
// velocity_of(i) (w: inverse mass, 0 = nothing moves it in this step), spin_of(i) (w: 1 = a contact is near), moved_of(i)
// (since contacts were found; w: speed when the sub-step began), turned_of(i) (rotation vector, since then; w: 1 = a
// contact slips), i counted in the world. Needs the bindings Settings, Progress, Bodies, Shapes, States, Tensors,
// Manifolds, Contacts, Order, Rows, and sphere/body.h.
#include "shared/language.h"
#include "shared/sphere/row.h"
#include "sphere/ball.h"
#include "sphere/placement.h"
#include "sphere/solve_step.h"

// A contact of this invocation's has changed its speed by more than `tolerance` in the sweep.
bool unconverged = false;

// A body as one manifold sees it.
struct Side {
  vec3 v, w;
  float inverse_mass;
  vec3 tensor, tensor_mixed;
};

// Of what cannot move nothing is read. Inertia of manifolds that are refreshed is of where their bodies are now.
Side side_of(uint body, bool refreshed) {
  Side s = Side(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0));
  if (body == SPHERE_GROUND) return s;
  uint i = body - world.bodies.x;
  s.inverse_mass = velocity_of(i).w;
  if (s.inverse_mass == 0.0) return s;
  s.v = velocity_of(i).xyz;
  s.w = spin_of(i).xyz;
  if (!refreshed) {
    s.tensor = tensors[body].diagonal.xyz;
    s.tensor_mixed = tensors[body].mixed.xyz;
    return s;
  }
  uint shape = bodies[body].ids.x;
  mat3 r = rotation_of(normalize(quat_multiply(quat_of_turn(turned_of(i).xyz), tensors[body].orientation)));
  mat3 t = r * symmetric(shapes[shape].inverse_inertia, shapes[shape].inverse_inertia_mixed) * transpose(r);
  t *= bodies[body].material.x;
  s.tensor = vec3(t[0][0], t[1][1], t[2][2]);
  s.tensor_mixed = vec3(t[0][1], t[0][2], t[1][2]);
  return s;
}

void keep_side(uint body, Side s) {
  if (s.inverse_mass == 0.0) return;
  uint i = body - world.bodies.x;
  velocity_of(i).xyz = s.v;
  spin_of(i).xyz = s.w;
}

// Where a body is: when contacts were found, half way through the step from there, and now.
struct Place {
  vec3 position, moved, turned;  // m, rad
  Ahead ahead;
  vec4 orientation;
};

Place place_of(uint body) {
  Place p = Place(vec3(0.0), vec3(0.0), vec3(0.0), Ahead(vec3(0.0), vec3(0.0)), vec4(0.0, 0.0, 0.0, 1.0));
  if (body == SPHERE_GROUND) return p;
  uint i = body - world.bodies.x;
  p.position = states[body].position.xyz;
  p.orientation = tensors[body].orientation;
  if (velocity_of(i).w == 0.0) return p;
  p.ahead = Ahead(plan.half_way * tensors[body].velocity.xyz, plan.half_way * tensors[body].spin.xyz);
  p.moved = moved_of(i).xyz;
  p.turned = turned_of(i).xyz;
  return p;
}

#include "sphere/contact_row.h"

SphereOrdered ordered_at(uint o) { return order[world.pairs.x + o]; }
void set_flags(uint o, uint flags) { order[world.pairs.x + o].flags = flags; }
uint first_row(SphereOrdered m) { return world.rows.x * SPHERE_ROW_PARTS + m.row; }

// Rows of a manifold.
#define FOR_ROWS(at, m)                                             \
  for (uint i = 0u, at = first_row(m); i < m.count; \
       ++i, at += SPHERE_ROW_PARTS * m.stride)
// The same, and the contacts that they are of.
#define FOR_CONTACTS(at, contact, m)                                                                     \
  for (uint i = 0u, at = first_row(m), contact = SPHERE_MAX_CONTACTS * (world.pairs.x + m.slot); i < m.count; \
       ++i, at += SPHERE_ROW_PARTS * m.stride, ++contact)

float friction_of(SphereOrdered m) { return grip * m.friction; }
bool refreshed(SphereOrdered m) { return (m.flags & SPHERE_REFRESHED) != 0u; }
bool restitutes(SphereOrdered m) { return (m.flags & SPHERE_RESTITUTES) != 0u; }
float restitution_of(SphereOrdered m) {
  return max(bodies[m.a].material.z, m.b == SPHERE_GROUND ? world.ground.y : bodies[m.b].material.z);
}

bool of_field_of_a(SphereContact c) { return (c.feature & SPHERE_SIDE_B) != 0u; }

// A row from its contact, with the force of the last step as impulse of a sub-step. Returns whether the contact is hit.
bool prepare_row(uint at, uint stride, SphereContact c, Place pa, Place pb, Side a, Side b) {
  Row row;
  row.ra = rotate(pa.orientation, c.anchor_a);
  row.rb = rotate(pb.orientation, c.anchor_b);
  bool of_a = of_field_of_a(c);
  row.normal = rotate(of_a ? pa.orientation : pb.orientation, c.normal.xyz);
  row.gap = dot(pb.position + row.rb - pa.position - row.ra, row.normal);
  go_half_way(of_a, pa.ahead, pb.ahead, row.ra, row.rb, row.normal);
  float scale = tangent_scale(row.normal), approach = approach_of(row, a, b);
  row.tangent = tangent_of(row.normal, scale);
  vec3 friction = c.force.yzw;
  row.impulse =
      kept * plan.sub_step * vec3(c.force.x, dot(friction, row.tangent), dot(friction, cross(row.normal, row.tangent)));
  rows[at + 2u * stride] = vec4(row.normal, scale);
  rows[at + 3u * stride].xyz = row.impulse;
  rows[at + 4u * stride] = vec4(row.gap, approach, row.impulse.x, 0.0);
  keep_levers(at, stride, row, a, b);
  return approach <= -settings.restitution_speed;
}

// Levers, gaps and masses of a manifold that is hit, of where its bodies are now.
void refresh_levers(SphereOrdered m, Side a, Side b) {
  Place pa = place_of(m.a), pb = place_of(m.b);
  vec3 x_a = pa.position + pa.moved, x_b = pb.position + pb.moved;
  vec4 q_a = normalize(quat_multiply(quat_of_turn(pa.turned), pa.orientation));
  vec4 q_b = normalize(quat_multiply(quat_of_turn(pb.turned), pb.orientation));
  FOR_CONTACTS(at, contact, m) {
    Row row = row_at(at, m.stride);
    SphereContact c = contacts[contact];
    vec3 on_a = x_a + rotate(q_a, c.anchor_a), on_b = x_b + rotate(q_b, c.anchor_b);
    row.gap = dot(levers_now(x_a, on_a, x_b, on_b, row.ra, row.rb), row.normal);
    keep_levers(at, m.stride, row, a, b);
  }
}

// Returns whether a contact closes fast.
bool prepare_manifold(uint o) {
  SphereOrdered m = ordered_at(o);
  Side a = side_of(m.a, false), b = side_of(m.b, false);
  Place pa = place_of(m.a), pb = place_of(m.b);
  bool strikes = false;
  FOR_CONTACTS(at, contact, m) strikes = prepare_row(at, m.stride, contacts[contact], pa, pb, a, b) || strikes;
  bool rolls = is_ball(m.a) || is_ball(m.b);  // the point where a ball touches does not turn with it
  m.flags = restitution_of(m) > 0.0 ? SPHERE_RESTITUTES : 0u;
  if (strikes) m.flags |= SPHERE_STRIKES | (rolls ? 0u : SPHERE_REFRESHED);
  set_flags(o, m.flags);
  float other = m.b == SPHERE_GROUND ? world.ground.x : bodies[m.b].material.y;
  order[world.pairs.x + o].friction = sqrt(bodies[m.a].material.y * other);
  if (refreshed(m)) refresh_levers(m, side_of(m.a, true), side_of(m.b, true));
  spin_of(m.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (m.b != SPHERE_GROUND) spin_of(m.b - world.bodies.x).w = 1.0;
  return strikes;
}

// Gaps of contacts, bodies having moved; to first order in the turns.
void observe_gaps(SphereOrdered m, Side a, Side b) {
  if (refreshed(m)) {
    refresh_levers(m, a, b);
    return;
  }
  Place pa = place_of(m.a), pb = place_of(m.b);
  FOR_ROWS(at, m) {
    Row row = row_at(at, m.stride);
    vec3 way = pb.moved + cross(pb.turned, row.rb) - pa.moved - cross(pa.turned, row.ra);
    rows[at].w = impact_at(at, m.stride).separation + dot(way, row.normal);
  }
}

void resist_turn(SphereOrdered m, inout Side a, inout Side b) {
  Patch area = open_patch(vec3(0.0));
  FOR_ROWS(at, m) gather(area, rows[at + 3u * m.stride].x, rows[at].xyz, rows[at + 2u * m.stride].xyz);
  if (area.impulse <= 0.0) return;
  close_patch(area, a.w - b.w);
  FOR_ROWS(at, m) spread(area, rows[at + 3u * m.stride].x, rows[at].xyz);
  float radius = settings.patch_radius * world.gravity.w, arm = is_ball(m.a) || is_ball(m.b) ? 0.0 : radius;
  resist(area.normal, area.spin, most_against_spin(area, radius, friction_of(m)), a, b);
  resist(area.tip_axis, area.tipping, most_against_tipping(area, radius, arm), a, b);
}

void solve_manifold(uint o, uint kind) {
  SphereOrdered m = ordered_at(o);
  if (kind == SWEEP_BOUNCE && (m.flags & SPHERE_BOUNCES) == 0u) return;
  Side a = side_of(m.a, refreshed(m)), b = side_of(m.b, refreshed(m));
  if (kind == SWEEP_WARM_START) {
    FOR_ROWS(at, m) warm_start(at, m.stride, restitutes(m), a, b);
  } else if (kind == SWEEP_BOUNCE) {
    FOR_ROWS(at, m) bounce(at, m.stride, restitution_of(m), a, b);
  } else {
    if (kind == SWEEP_FIRST_PUSH) resist_turn(m, a, b);
    if (kind == SWEEP_FIRST_RELAX) observe_gaps(m, a, b);
    Give give = firmly_now;
    if (kind == SWEEP_FIRST_PUSH || kind == SWEEP_PUSH) give = softly_now;
    FOR_ROWS(at, m) solve_normal(at, m.stride, give, a, b);
    float friction = friction_of(m);
    FOR_ROWS(at, m) solve_friction(at, m.stride, friction, a, b);
  }
  keep_side(m.a, a);
  if (m.b != SPHERE_GROUND) keep_side(m.b, b);
}

// Whether a contact of the manifold is to bounce.
bool bounces(uint o) {
  SphereOrdered m = ordered_at(o);
  if (!restitutes(m) || (m.flags & SPHERE_STRIKES) == 0u) return false;
  bool any = false;
  FOR_ROWS(at, m) {
    Impact impact = impact_at(at, m.stride);
    any = any || impact.pressed == 1.0 && hit(row_at(at, m.stride), impact);
  }
  if (any) set_flags(o, m.flags | SPHERE_BOUNCES);
  return any;
}

// Impulses back into the contacts, as forces. An impact is over: it must not warm-start the next step.
void keep_forces(uint o) {
  SphereOrdered m = ordered_at(o);
  uint presses = 0u;
  FOR_CONTACTS(at, contact, m) {
    Row row = row_at(at, m.stride);
    Impact impact = impact_at(at, m.stride);
    if ((m.flags & SPHERE_BOUNCES) != 0u && hit(row, impact)) row.impulse = vec3(0.0);
    vec3 impulse = without_impact(row, impact, restitutes(m));
    vec3 friction = impulse.y * row.tangent + impulse.z * cross(row.normal, row.tangent);
    contacts[contact].force = vec4(impulse.x, friction) / plan.sub_step;
    if (impulse.x > 0.0) presses = 1u;
  }
  manifolds[world.pairs.x + m.slot].state.y = presses;
}

// Bodies with a contact that has all the friction that its force allows.
void note_sliding(uint o) {
  SphereOrdered m = ordered_at(o);
  float friction = friction_of(m);
  bool slip = false;
  FOR_ROWS(at, m) {
    vec3 impulse = rows[at + 3u * m.stride].xyz;
    slip = slip || slips(friction * impulse.x, impulse.y, impulse.z);
  }
  if (!slip) return;
  turned_of(m.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (m.b != SPHERE_GROUND) turned_of(m.b - world.bodies.x).w = 1.0;
}
