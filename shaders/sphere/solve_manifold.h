// Manifolds in the solve: the work of one invocation on one manifold. The includer defines where velocities are stored:
// velocity_of(i) (w: inverse mass, 0 = nothing moves it in this step), spin_of(i) (w: 1 = a contact is near), moved_of(i)
// (since contacts were found; w: speed when the sub-step began), turned_of(i) (rotation vector, since then; w: 1 = a
// contact slips), i counted in the world. Needs the bindings Settings, Progress, Bodies, Shapes, States, Tensors,
// Manifolds, Contacts, Order, Rows, Impulses, and sphere/body.h.
#include "shared/language.h"
#include "shared/sphere/row.h"
#include "sphere/ball.h"
#include "sphere/near.h"
#include "sphere/ordered.h"
#include "sphere/pair_material.h"
#include "sphere/solve_step.h"

#include "sphere/contact_row.h"

// A contact of this invocation's has changed its speed by more than `tolerance` in the sweep.
bool unconverged = false;

#include "sphere/contact_sweep.h"

// Inertia of manifolds that are refreshed is of where their bodies are now. What cannot move has neither speed nor inertia.
Side side_of(uint i, float inverse_mass, bool refreshed) {
  Side s = Side(spin_of(i).xyz, inverse_mass, vec3(0.0), vec3(0.0));
  if (s.inverse_mass == 0.0) return s;
  uint body = world.bodies.x + i;
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

// impulse: on the body, of all contacts together (N s).
void keep_side(uint i, vec3 v, vec3 impulse, Side s) {
  if (s.inverse_mass == 0.0) return;
  velocity_of(i) = vec4(v + s.inverse_mass * impulse, s.inverse_mass);
  spin_of(i) = vec4(s.w, 1.0);  // a contact is near
}

// Where a body is now, and how far it has moved since contacts were found (m, rad).
struct Place {
  vec3 position;
  vec4 orientation;
};

Place place_of(uint i) {
  if (i == SPHERE_GROUND_BODY) return Place(vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0));
  uint body = world.bodies.x + i;
  if (velocity_of(i).w == 0.0) return Place(states[body].position.xyz, tensors[body].orientation);
  return Place(states[body].position.xyz + moved_of(i).xyz,
               normalize(quat_multiply(quat_of_turn(turned_of(i).xyz), tensors[body].orientation)));
}

// What cannot move has not.
struct Displacement {
  vec3 moved, turned;
};

Displacement displacement_of(uint i) { return Displacement(moved_of(i).xyz, turned_of(i).xyz); }

// A manifold as a sweep sees it.
struct Manifold {
  uint a, b;  // bodies, counted in the world
  uint kind, stride, row;
  float slack, arm, yield, friction;
};

Manifold manifold_at(uint o) {
  SphereOrdered m = order[world.pairs.x + o];
  return Manifold(first_of_bodies(m.bodies), second_of_bodies(m.bodies), m.kind, stride_of(m.kind),
                  world.rows.x * SPHERE_ROW_PARTS + m.row, m.slack, m.arm, m.yield, m.friction);
}
Members members_at(uint o) { return bodies_of(world, order[world.pairs.x + o].bodies); }
bool has(Manifold m, uint flag) { return (m.kind & flag) != 0u; }

uint first_contact(uint o) { return SPHERE_MAX_CONTACTS * (world.pairs.x + order[world.pairs.x + o].slot); }

// Rows of a manifold and the contacts that they are of.
#define FOR_CONTACTS(at, contact, m, o)                                                             \
  for (uint at = m.row, contact = first_contact(o), end_contact = contact + count_of(m.kind); contact < end_contact; \
       at += SPHERE_ROW_PARTS * m.stride, ++contact)
// Rows of the contacts that may press. Each invocation processes them one by one.
#define FOR_NEAR(at, m)                                                            \
  for (uint left = near_of(m.kind), at = row_of(m, left); left != 0u; \
       left &= left - 1u, at = row_of(m, left))
uint row_of(Manifold m, uint left) { return m.row + SPHERE_ROW_PARTS * m.stride * uint(findLSB(left)); }

float friction_of(Manifold m) { return friction_share * m.friction; }
// Returns whether a contact closes fast.
bool begin_manifold(uint o) {
  Manifold m = manifold_at(o);
  spin_of(m.a).w = spin_of(m.b).w = 1.0;  // all that come here write the same
  return has(m, SPHERE_STRIKES);
}

// Which contacts may press.
void keep_near(uint o, uint near, inout Manifold m) {
  m.kind = with_near(m.kind, near);
  order[world.pairs.x + o].kind = m.kind;
  order[world.pairs.x + o].slack = m.slack;
}

// Gap of a contact, bodies having moved; to first order in the turns.
float gap_now(uint at, uint stride, Displacement a, Displacement b) {
  Row row = row_at(at, stride);
  vec3 moved = b.moved + cross(b.turned, row.rb) - a.moved - cross(a.turned, row.ra);
  return found_gap_at(at, stride) + dot(moved, row.normal);
}

// Levers, gap and masses of a contact that is hit, of where its bodies are now; returns the gap.
float refresh_row(uint at, uint stride, SphereContact c, Place pa, Place pb, Sides s) {
  Row row = row_at(at, stride);
  vec3 on_a = pa.position + rotate(pa.orientation, c.anchor_a), on_b = pb.position + rotate(pb.orientation, c.anchor_b);
  float gap = dot(levers_now(pa.position, on_a, pb.position, on_b, row.ra, row.rb), row.normal);
  keep_row(at, stride, row, found_gap_at(at, stride), s);
  return gap;
}

// Gaps when bodies have moved, and which contacts may press from now on. What is hit keeps all.
void observe(uint o, bool refreshed, Sides s, inout Manifold m) {
  Displacement by_a = displacement_of(m.a), by_b = displacement_of(m.b);
  Place pa = Place(vec3(0.0), vec4(0.0)), pb = pa;
  if (refreshed) {
    pa = place_of(m.a);
    pb = place_of(m.b);
  }
  float reach = NEAR_REACH * plan.sub_step * reach_of(s.between, s.a.w, s.b.w, m.arm);
  bool all_may = has(m, SPHERE_STRIKES);
  uint near = 0u, count = count_of(m.kind), contact = refreshed ? first_contact(o) : 0u;
  m.slack = NO_LIMIT;
  for (uint k = 0u, at = m.row; k < count; ++k, at += SPHERE_ROW_PARTS * m.stride) {
    float gap;
    if (refreshed)
      gap = refresh_row(at, m.stride, contacts[contact + k], pa, pb, s);
    else
      gap = gap_now(at, m.stride, by_a, by_b);
    impulses[at].y = gap;
    if (all_may || impulses[at].x > 0.0 || !(gap > reach))
      near |= 1u << k;
    else
      m.slack = min(m.slack, gap);
  }
  keep_near(o, near, m);
}

void resist_turn(Manifold m, inout Sides s) {
  Patch area = open_patch(vec3(0.0));
  FOR_NEAR(at, m) gather(area, impulses[at].x, rows[at + m.stride].xyz, rows[at].xyz);
  if (area.impulse <= 0.0) return;
  close_patch(area, s.a.w - s.b.w);
  FOR_NEAR(at, m) spread(area, impulses[at].x, rows[at + m.stride].xyz);
  float radius = settings.patch_radius * world.gravity.w;
  float arm = is_ball(world.bodies.x + m.a) || m.b != SPHERE_GROUND_BODY && is_ball(world.bodies.x + m.b) ? 0.0 : radius;
  resist(area.normal, area.spin, most_against_spin(area, radius, friction_of(m)), s);
  resist(area.tip_axis, area.tipping, most_against_tipping(area, radius, arm), s);
}

// The bodies approach each other too fast to leave out any contact in this sub-step.
void all_may_press(uint o, inout Manifold m) {
  m.slack = NO_LIMIT;
  keep_near(o, all_of(count_of(m.kind)), m);
}

// The normal of a contact. Returns whether there may be friction.
bool push_contact(uint o, uint at, Row row, Give give, inout float reach, inout Manifold m, inout Sides s) {
  float change;
  bool slides = solve_normal(at, m.stride, row, give, has(m, SPHERE_STRIKES), change, s);
  reach += plan.sub_step * m.yield * abs(change);
  if (!(reach < m.slack)) all_may_press(o, m);
  return slides;
}

// All normals, then all friction. Most manifolds have one contact that presses: the row of the first one stays in
// registers between the two.
void push_manifold(uint o, Give give, Manifold m, inout Sides s) {
  float reach = plan.sub_step * reach_of(s.between, s.a.w, s.b.w, m.arm);
  if (!(reach < m.slack)) all_may_press(o, m);
  uint left = near_of(m.kind), slides = 0u;  // a bit a contact
  if (left == 0u) return;
  uint first = row_of(m, left), done = left ^ left - 1u;  // contacts up to this one
  Row row = row_at(first, m.stride);
  bool first_slides = push_contact(o, first, row, give, reach, m, s);
  while ((left = near_of(m.kind) & ~done) != 0u) {
    done = left ^ left - 1u;
    uint at = row_of(m, left);
    if (push_contact(o, at, row_at(at, m.stride), give, reach, m, s)) slides |= left & done;
  }
  float friction = friction_of(m);
  if (first_slides) solve_friction(first, m.stride, row, friction, s);
  for (; slides != 0u; slides &= slides - 1u) {
    uint at = row_of(m, slides);
    solve_friction(at, m.stride, row_at(at, m.stride), friction, s);
  }
}

// What a manifold does in sweeps other than those that merely repeat the one before. Few loops: on llvmpipe each costs a
// turn even where it is not run, and an invocation has 65,535.
void begin_sweep(uint o, uint kind, bool refreshed, inout Manifold m, inout Sides s) {
  if (kind == SWEEP_FIRST_RELAX || refreshed && kind == SWEEP_WARM_START && first_sub_step) observe(o, refreshed, s, m);
  if (kind == SWEEP_FIRST_PUSH) resist_turn(m, s);
  if (kind != SWEEP_WARM_START && !(kind == SWEEP_BOUNCE && has(m, SPHERE_BOUNCES))) return;
  uint contact = first_contact(o);
  FOR_NEAR(at, m) {
    float approach = contacts[contact + uint(findLSB(left))].approach;
    if (kind == SWEEP_WARM_START)
      warm_start(at, m.stride, has(m, SPHERE_RESTITUTES) && strikes(approach), s);
    else
      bounce(at, m.stride, restitution_of(members_at(o)), approach, s);
  }
}

void solve_manifold(uint o, uint kind, Give give) {
  Manifold m = manifold_at(o);
  bool refreshed = has(m, SPHERE_REFRESHED);
  vec4 va = velocity_of(m.a), vb = velocity_of(m.b);
  vec3 between = vb.xyz - va.xyz;
  Sides s = Sides(side_of(m.a, va.w, refreshed), side_of(m.b, vb.w, refreshed), between);
  if (kind >= SWEEP_FIRST_PUSH) begin_sweep(o, kind, refreshed, m, s);
  if (kind <= SWEEP_FIRST_RELAX) push_manifold(o, give, m, s);
  vec3 impulse = 1.0 / inverse_masses(s) * (s.between - between);
  keep_side(m.a, va.xyz, -impulse, s.a);
  keep_side(m.b, vb.xyz, impulse, s.b);
}

// Whether a contact of the manifold is to bounce.
bool bounces(uint o) {
  Manifold m = manifold_at(o);
  if (!has(m, SPHERE_RESTITUTES) || !has(m, SPHERE_STRIKES)) return false;
  bool any = false;
  FOR_CONTACTS(at, contact, m, o)
    any = any || pressed_at(at, m.stride) && is_hit(at, m.stride, contacts[contact].approach);
  if (any) order[world.pairs.x + o].kind = m.kind | SPHERE_BOUNCES;
  return any;
}

// Impulses back into the contacts, as forces. An impact is over: it must not warm-start the next step.
void keep_forces(uint o) {
  Manifold m = manifold_at(o);
  bool restitutes = has(m, SPHERE_RESTITUTES);
  uint presses = 0u;
  FOR_CONTACTS(at, contact, m, o) {
    float share = 1.0, approach = contacts[contact].approach;
    if (!restitutes || !strikes(approach))
      share = lasting_share_at(at, m.stride, rows[at].w);
    else if (has(m, SPHERE_BOUNCES) && is_hit(at, m.stride, approach))
      share = 0.0;
    contacts[contact].force = share / plan.sub_step * vec4(impulses[at].x, friction_at(at, m.stride));
    if (share * impulses[at].x > 0.0) ++presses;
  }
  uint slot = world.pairs.x + order[world.pairs.x + o].slot;
  manifolds[slot].state.y = presses;
  manifolds[slot].state.w = uint(bitCount(near_of(m.kind))) + presses;
}

// Bodies with a contact that has all the friction that its force allows.
void note_sliding(uint o) {
  Manifold m = manifold_at(o);
  float friction = friction_of(m);
  bool slip = false;
  FOR_NEAR(at, m) slip = slip || slips(friction * impulses[at].x, length(friction_at(at, m.stride)), 0.0);
  if (slip) turned_of(m.a).w = turned_of(m.b).w = 1.0;  // all that come here write the same
}
