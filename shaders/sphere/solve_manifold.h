// The work of one invocation on one manifold in the solve. The includer defines for body i of the world: velocity_of(i)
// (m/s; w: inverse mass, 0 if not moved in this step), spin_of(i) (rad/s; w: 1 if a contact is near), moved_of(i) (m,
// displacement since the start of the step; w: speed at the start of the sub-step), turned_of(i) (rad, rotation vector
// since the start of the step; w: 1 if a contact slips). Needs the bindings Settings, Progress, Bodies, Shapes, States,
// Tensors, Manifolds, Contacts, Order, Rows, Impulses, and sphere/body.h.
#include "shared/language.h"
#include "shared/sphere/row.h"
#include "shared/sphere/wait.h"
#include "sphere/ball.h"
#include "sphere/near.h"
#include "sphere/ordered.h"
#include "sphere/pair_material.h"
#include "sphere/solve_step.h"

#include "sphere/contact_row.h"

// Whether the sweep has changed the speed at a contact of this invocation by more than `tolerance`.
bool unconverged = false;

#include "sphere/contact_sweep.h"

// Returns body i as a side of a manifold. refreshed: with the inertia of its present pose. All is 0 if it cannot move.
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

// Stores the velocities of body i. v: its velocity before (m/s); impulse: sum of all contacts' impulses on it (N s).
void keep_side(uint i, vec3 v, vec3 impulse, Side s) {
  if (s.inverse_mass == 0.0) return;
  velocity_of(i) = vec4(v + s.inverse_mass * impulse, s.inverse_mass);
  spin_of(i) = vec4(s.w, 1.0);  // w: a contact is near
}

// The present pose of a body.
struct Place {
  vec3 position;     // centre of mass (m)
  vec4 orientation;  // x, y, z, w; from body to world axes
};

Place place_of(uint i) {
  if (i == SPHERE_GROUND_BODY) return Place(vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0));
  uint body = world.bodies.x + i;
  if (velocity_of(i).w == 0.0) return Place(states[body].position.xyz, tensors[body].orientation);
  return Place(states[body].position.xyz + moved_of(i).xyz,
               normalize(quat_multiply(quat_of_turn(turned_of(i).xyz), tensors[body].orientation)));
}

// Motion of a body since the start of the step; 0 if it cannot move.
struct Displacement {
  vec3 moved, turned;  // displacement (m), rotation vector (rad)
};

Displacement displacement_of(uint i) { return Displacement(moved_of(i).xyz, turned_of(i).xyz); }

// The members of SphereOrdered that a sweep needs.
struct Manifold {
  uint a, b;  // indices of the bodies within the world
  uint kind, stride, row;  // row: index of the first row among those of all worlds, in vec4
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

// Loops over the rows (at) and the contacts (contact) of a manifold.
#define FOR_CONTACTS(at, contact, m, o)                                                             \
  for (uint at = m.row, contact = first_contact(o), end_contact = contact + count_of(m.kind); contact < end_contact; \
       at += SPHERE_ROW_PARTS * m.stride, ++contact)
// Loops over the rows of the contacts that may press.
#define FOR_NEAR(at, m)                                                            \
  for (uint left = near_of(m.kind), at = row_of(m, left); left != 0u; \
       left &= left - 1u, at = row_of(m, left))
uint row_of(Manifold m, uint left) { return m.row + SPHERE_ROW_PARTS * m.stride * uint(findLSB(left)); }

float friction_of(Manifold m) { return friction_share * m.friction; }
// Marks the bodies of manifold o as near a contact. Returns whether a contact of the manifold closes fast; meets: and
// the bodies did not press on each other before.
bool begin_manifold(uint o, out bool meets) {
  Manifold m = manifold_at(o);
  spin_of(m.a).w = spin_of(m.b).w = 1.0;  // all invocations write the same value
  meets = has(m, SPHERE_STRIKES);
  if (!meets) return false;
  FOR_NEAR(at, m) meets = meets && !(impulses[at].x > 0.0);
  return true;
}

// Stores which contacts of manifold o may press (near: a bit for each), and the lower bound of the other gaps.
void keep_near(uint o, uint near, inout Manifold m) {
  m.kind = with_near(m.kind, near);
  order[world.pairs.x + o].kind = m.kind;
  order[world.pairs.x + o].slack = m.slack;
}

// Returns the gap (m) of a contact after the motion of its bodies; the rotation is linearised.
float gap_now(uint at, uint stride, Displacement a, Displacement b) {
  Row row = row_at(at, stride);
  vec3 moved = b.moved + cross(b.turned, row.rb) - a.moved - cross(a.turned, row.ra);
  return found_gap_at(at, stride) + dot(moved, row.normal);
}

// Computes the lever arms and masses of a contact of a refreshed manifold at the present poses. Returns its gap (m).
float refresh_row(uint at, uint stride, SphereContact c, Place pa, Place pb, Sides s) {
  Row row = row_at(at, stride);
  vec3 on_a = pa.position + rotate(pa.orientation, c.anchor_a), on_b = pb.position + rotate(pb.orientation, c.anchor_b);
  float gap = dot(levers_now(pa.position, on_a, pb.position, on_b, row.ra, row.rb), row.normal);
  keep_row(at, stride, row, found_gap_at(at, stride), s);
  return gap;
}

// Updates the gaps after bodies have moved, and which contacts may press from now on; all may if one of them strikes.
void observe(uint o, bool refreshed, Sides s, inout Manifold m) {
  Displacement by_a = displacement_of(m.a), by_b = displacement_of(m.b);
  Place pa = Place(vec3(0.0), vec4(0.0)), pb = pa;
  if (refreshed) {
    pa = place_of(m.a);
    pb = place_of(m.b);
  }
  float reach = NEAR_REACH * plan.sub_step * reach_of(s.between, s.a.w, s.b.w, m.arm);
  bool all_may = has(m, SPHERE_STRIKES);
  float force = 0.0;
  vec3 push = vec3(0.0);
  uint near = 0u, apart = 0u, count = count_of(m.kind), contact = refreshed ? first_contact(o) : 0u;
  m.slack = NO_LIMIT;
  for (uint k = 0u, at = m.row; k < count; ++k, at += SPHERE_ROW_PARTS * m.stride) {
    float gap;
    if (refreshed)
      gap = refresh_row(at, m.stride, contacts[contact + k], pa, pb, s);
    else
      gap = gap_now(at, m.stride, by_a, by_b);
    float impulse = impulses[at].x;
    impulses[at].y = gap;
    if (all_may || impulse > 0.0 || !(gap > reach))
      near |= 1u << k;
    else
      m.slack = min(m.slack, gap);
    if (gap > 0.0) apart |= 1u << k;
    force += impulse;
    push += impulse * rows[at].xyz;
  }
  if (force <= 0.0 || any_meets()) apart = 0u;
  uint waiting = 0u;
  for (; apart != 0u; apart &= apart - 1u) {
    uint at = row_of(m, apart);
    if (waits(impulses[at].y, impulses[at].x, rows[at].xyz, force, push)) waiting |= apart & ~(apart - 1u);
  }
  m.kind = with_waiting(m.kind, waiting);
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

// Marks all contacts of manifold o as near, because its bodies approach each other too fast to leave any out.
void all_may_press(uint o, inout Manifold m) {
  m.slack = NO_LIMIT;
  keep_near(o, all_of(count_of(m.kind)), m);
}

// Solves the normal impulse of a contact, and updates `reach` (m). Returns whether it may have friction.
bool push_contact(uint o, uint at, Row row, Give give, inout float reach, inout Manifold m, inout Sides s) {
  float change;
  bool slides = solve_normal(at, m.stride, row, give, has(m, SPHERE_STRIKES), change, s);
  reach += plan.sub_step * m.yield * abs(change);
  if (!(reach < m.slack)) all_may_press(o, m);
  return slides;
}

// Solves all normal impulses of a manifold, then all friction. waiting: a bit for each contact that is left out. Most
// manifolds have one contact that presses: the row of the first contact stays in registers between the two.
void push_manifold(uint o, Give give, uint waiting, Manifold m, inout Sides s) {
  float reach = plan.sub_step * reach_of(s.between, s.a.w, s.b.w, m.arm);
  if (!(reach < m.slack)) all_may_press(o, m);
  uint left = near_of(m.kind) & ~waiting, slides = 0u;  // one bit for each contact
  if (left == 0u) return;
  uint first = row_of(m, left), done = waiting | left ^ left - 1u;  // done: bits of all contacts up to this one
  Row row = row_at(first, m.stride);
  bool first_slides = push_contact(o, first, row, give, reach, m, s);
  while ((left = near_of(m.kind) & ~done) != 0u) {
    uint at = row_of(m, left);
    done |= left ^ left - 1u;
    if (push_contact(o, at, row_at(at, m.stride), give, reach, m, s)) slides |= left & ~(left - 1u);
  }
  float friction = friction_of(m);
  if (first_slides) solve_friction(first, m.stride, row, friction, s);
  for (; slides != 0u; slides &= slides - 1u) {
    uint at = row_of(m, slides);
    solve_friction(at, m.stride, row_at(at, m.stride), friction, s);
  }
}

// Does the additional work of a manifold in special kinds of sweeps (SWEEP_FIRST_PUSH and above). It has few loops: on
// llvmpipe, each costs an iteration even if it is not run, and an invocation has at most 65,535.
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
  bool relaxes = kind == SWEEP_RELAX || kind == SWEEP_FIRST_RELAX;
  if (kind <= SWEEP_FIRST_RELAX) push_manifold(o, give, relaxes ? waiting_of(m.kind) : 0u, m, s);
  vec3 impulse = 1.0 / inverse_masses(s) * (s.between - between);
  keep_side(m.a, va.xyz, -impulse, s.a);
  keep_side(m.b, vb.xyz, impulse, s.b);
}

// Returns whether a contact of manifold o must bounce at the end of the step, and sets the flag SPHERE_BOUNCES.
bool bounces(uint o) {
  Manifold m = manifold_at(o);
  if (!has(m, SPHERE_RESTITUTES) || !has(m, SPHERE_STRIKES)) return false;
  bool any = false;
  FOR_CONTACTS(at, contact, m, o)
    any = any || pressed_at(at, m.stride) && is_hit(at, m.stride, contacts[contact].approach);
  if (any) order[world.pairs.x + o].kind = m.kind | SPHERE_BOUNCES;
  return any;
}

// Stores the impulses as forces in the contacts. The part due to an impact is omitted: it must not warm-start a step.
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

// Marks the bodies of manifold o as slipping if a contact has the limit of its friction.
void note_sliding(uint o) {
  Manifold m = manifold_at(o);
  float friction = friction_of(m);
  bool slip = false;
  FOR_NEAR(at, m) slip = slip || slips(friction * impulses[at].x, length(friction_at(at, m.stride)), 0.0);
  if (slip) turned_of(m.a).w = turned_of(m.b).w = 1.0;  // all invocations write the same value
}
