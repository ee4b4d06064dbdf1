// Manifolds in the solve: what one invocation does with one of them. Whoever includes this says where velocities lie:
// velocity_of(i) (w: inverse mass, 0 = nothing moves it in this step), spin_of(i) (w: 1 = a contact is near), moved_of(i)
// (since contacts were found; w: speed when the sub-step began), turned_of(i) (rotation vector, since then; w: 1 = a
// contact slips), i counted in the world. Needs the bindings Settings, Progress, Bodies, Shapes, States, Tensors,
// Manifolds, Contacts, Order, Rows, Impulses, and sphere/body.h.
#include "shared/language.h"
#include "shared/sphere/row.h"
#include "sphere/ball.h"
#include "sphere/pair_material.h"
#include "sphere/solve_step.h"

#include "sphere/contact_row.h"

// A contact of this invocation's has changed its speed by more than `tolerance` in the sweep.
bool unconverged = false;

#include "sphere/contact_sweep.h"

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
  velocity_of(i) = vec4(s.v, s.inverse_mass);
  spin_of(i) = vec4(s.w, 1.0);  // a contact is near
}

// Where a body is now, and how far it has moved since contacts were found (m, rad).
struct Place {
  vec3 position;
  vec4 orientation;
};

Place place_of(uint body) {
  if (body == SPHERE_GROUND) return Place(vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0));
  uint i = body - world.bodies.x;
  if (velocity_of(i).w == 0.0) return Place(states[body].position.xyz, tensors[body].orientation);
  return Place(states[body].position.xyz + moved_of(i).xyz,
               normalize(quat_multiply(quat_of_turn(turned_of(i).xyz), tensors[body].orientation)));
}

struct Way {
  vec3 moved, turned;
};

Way way_of(uint body) {
  if (body == SPHERE_GROUND || velocity_of(body - world.bodies.x).w == 0.0) return Way(vec3(0.0), vec3(0.0));
  return Way(moved_of(body - world.bodies.x).xyz, turned_of(body - world.bodies.x).xyz);
}

SphereOrdered ordered_at(uint o) { return order[world.pairs.x + o]; }
void set_flags(uint o, uint flags) { order[world.pairs.x + o].flags = flags; }

uint first_row(SphereOrdered m) { return world.rows.x * SPHERE_ROW_PARTS + m.row; }

uint first_contact(SphereOrdered m) { return SPHERE_MAX_CONTACTS * (world.pairs.x + m.slot); }

// Rows of a manifold.
#define FOR_ROWS(at, m)                                             \
  for (uint i = 0u, at = first_row(m); i < m.count; \
       ++i, at += SPHERE_ROW_PARTS * m.stride)
// The same, and the contacts that they are of.
#define FOR_CONTACTS(at, contact, m)                                                                     \
  for (uint i = 0u, at = first_row(m), contact = first_contact(m); i < m.count;                          \
       ++i, at += SPHERE_ROW_PARTS * m.stride, ++contact)

float friction_of(SphereOrdered m) { return grip * m.friction; }
bool refreshed(SphereOrdered m) { return (m.flags & SPHERE_REFRESHED) != 0u; }
bool restitutes(SphereOrdered m) { return (m.flags & SPHERE_RESTITUTES) != 0u; }
// Levers, gaps and masses of a manifold that is hit, of where its bodies are now.
void refresh_levers(SphereOrdered m, Side a, Side b) {
  Place pa = place_of(m.a), pb = place_of(m.b);
  FOR_CONTACTS(at, contact, m) {
    Row row = row_at(at, m.stride);
    SphereContact c = contacts[contact];
    vec3 on_a = pa.position + rotate(pa.orientation, c.anchor_a), on_b = pb.position + rotate(pb.orientation, c.anchor_b);
    impulses[at].y = dot(levers_now(pa.position, on_a, pb.position, on_b, row.ra, row.rb), row.normal);
    keep_row(at, m.stride, row, found_gap_at(at, m.stride), a, b);
  }
}

// Returns whether a contact closes fast.
bool begin_manifold(uint o) {
  SphereOrdered m = ordered_at(o);
  spin_of(m.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (m.b != SPHERE_GROUND) spin_of(m.b - world.bodies.x).w = 1.0;
  return (m.flags & SPHERE_STRIKES) != 0u;
}

// Gaps of contacts, bodies having moved; to first order in the turns.
void observe_gaps(SphereOrdered m) {
  Way a = way_of(m.a), b = way_of(m.b);
  FOR_ROWS(at, m) {
    Row row = row_at(at, m.stride);
    vec3 way = b.moved + cross(b.turned, row.rb) - a.moved - cross(a.turned, row.ra);
    impulses[at].y = found_gap_at(at, m.stride) + dot(way, row.normal);
  }
}

void resist_turn(SphereOrdered m, inout Side a, inout Side b) {
  Patch area = open_patch(vec3(0.0));
  FOR_ROWS(at, m) gather(area, impulses[at].x, rows[at + m.stride].xyz, rows[at].xyz);
  if (area.impulse <= 0.0) return;
  close_patch(area, a.w - b.w);
  FOR_ROWS(at, m) spread(area, impulses[at].x, rows[at + m.stride].xyz);
  float radius = settings.patch_radius * world.gravity.w, arm = is_ball(m.a) || is_ball(m.b) ? 0.0 : radius;
  resist(area.normal, area.spin, most_against_spin(area, radius, friction_of(m)), a, b);
  resist(area.tip_axis, area.tipping, most_against_tipping(area, radius, arm), a, b);
}

void push_manifold(SphereOrdered m, bool pushes, inout Side a, inout Side b) {
  Give give = firmly_now;
  if (pushes) give = softly_now;
  uint rubs = 0u;  // a bit a contact
  FOR_ROWS(at, m) if (solve_normal(at, m.stride, give, (m.flags & SPHERE_STRIKES) != 0u, a, b)) rubs |= 1u << i;
  // Each invocation goes from one contact that presses to the next: half of all only wait for their gap to close.
  for (float friction = friction_of(m); rubs != 0u; rubs &= rubs - 1u)
    solve_friction(first_row(m) + SPHERE_ROW_PARTS * m.stride * uint(findLSB(rubs)), m.stride, friction, a, b);
}

void solve_manifold(uint o, uint kind) {
  SphereOrdered m = ordered_at(o);
  if (kind == SWEEP_BOUNCE && (m.flags & SPHERE_BOUNCES) == 0u) return;
  Side a = side_of(m.a, refreshed(m)), b = side_of(m.b, refreshed(m));
  if (refreshed(m) && (kind == SWEEP_FIRST_RELAX || kind == SWEEP_WARM_START && first_sub_step)) refresh_levers(m, a, b);
  if (kind == SWEEP_WARM_START) {
    FOR_CONTACTS(at, contact, m)
      warm_start(at, m.stride, restitutes(m) && strikes(contacts[contact].approach), a, b);
  } else if (kind == SWEEP_BOUNCE) {
    FOR_CONTACTS(at, contact, m) bounce(at, m.stride, restitution_of(m), contacts[contact].approach, a, b);
  } else {
    if (kind == SWEEP_FIRST_PUSH) resist_turn(m, a, b);
    if (kind == SWEEP_FIRST_RELAX && !refreshed(m)) observe_gaps(m);
    push_manifold(m, kind == SWEEP_FIRST_PUSH || kind == SWEEP_PUSH, a, b);
  }
  keep_side(m.a, a);
  if (m.b != SPHERE_GROUND) keep_side(m.b, b);
}

// Whether a contact of the manifold is to bounce.
bool bounces(uint o) {
  SphereOrdered m = ordered_at(o);
  if (!restitutes(m) || (m.flags & SPHERE_STRIKES) == 0u) return false;
  bool any = false;
  FOR_CONTACTS(at, contact, m)
    any = any || pressed_at(at, m.stride) && is_hit(at, m.stride, contacts[contact].approach);
  if (any) set_flags(o, m.flags | SPHERE_BOUNCES);
  return any;
}

// Impulses back into the contacts, as forces. An impact is over: it must not warm-start the next step.
void keep_forces(uint o) {
  SphereOrdered m = ordered_at(o);
  uint presses = 0u;
  FOR_CONTACTS(at, contact, m) {
    float share = 1.0, approach = contacts[contact].approach;
    if (!restitutes(m) || !strikes(approach))
      share = lasting_share_at(at, m.stride, rows[at].w);
    else if ((m.flags & SPHERE_BOUNCES) != 0u && is_hit(at, m.stride, approach))
      share = 0.0;
    contacts[contact].force = share / plan.sub_step * vec4(impulses[at].x, friction_at(at, m.stride));
    if (share * impulses[at].x > 0.0) presses = 1u;
  }
  manifolds[world.pairs.x + m.slot].state.y = presses;
}

// Bodies with a contact that has all the friction that its force allows.
void note_sliding(uint o) {
  SphereOrdered m = ordered_at(o);
  float friction = friction_of(m);
  bool slip = false;
  FOR_ROWS(at, m) {
    slip = slip || slips(friction * impulses[at].x, length(friction_at(at, m.stride)), 0.0);
  }
  if (!slip) return;
  turned_of(m.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (m.b != SPHERE_GROUND) turned_of(m.b - world.bodies.x).w = 1.0;
}
