// Bodies and manifolds in the solve: what one invocation does with one of them. Whoever includes this says where
// velocities lie: velocity_of(i) (w: inverse mass, 0 = nothing moves it in this step), spin_of(i) (w: 1 = a contact is
// near), moved_of(i) (since contacts were found), turned_of(i) (rotation vector, since then), i counted in the world.
// Needs the bindings Settings, Progress, Bodies, Shapes, States, Tensors, Pairs, Manifolds, Contacts, Order, and
// sphere/body.h.

#include "sphere/placement.h"

SphereWorld world;
uint list;
vec4 softness;    // of contacts: rate (Hz), damping ratio, slop (d), sub-steps in place of one
uint sub_steps;   // of this step: more than by the softness in high heaps
float grip;       // share of friction that holds
float kept;       // share of the last step's forces that this one begins with
float time_step;  // s, of this step

float sub_step() { return time_step / float(sub_steps); }

// What holds for sub-step k of world w.
void take_sub_step_of(uint w, uint k) {
  bool forgets = progress[w].forgets != 0u;
  time_step = progress[w].time_step;
  softness = settings.softness[progress[w].stiffness];
  sub_steps = settings.sub_steps * progress[w].refinement;
  bool slip = forgets && progress[w].stiffness == SPHERE_RIGID;
  uint slips = slip ? max(1u, uint(settings.probe_slip / sub_step() + 0.5)) : 0u;
  grip = k < slips ? 0.0 : progress[w].grip;
  kept = forgets ? 0.0 : 1.0;
}

// A body as one manifold sees it.
struct Side {
  vec3 v, w, moved, turned, position;
  vec3 ahead, ahead_turn;  // from the step's start to half way through it (m, rad)
  vec4 orientation;
  float inverse_mass;
  vec3 tensor, tensor_mixed;
};

Side side_of(uint body) {
  Side s = Side(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0),
                0.0, vec3(0.0), vec3(0.0));
  if (body == SPHERE_GROUND) return s;
  uint i = body - world.bodies.x;
  s.position = states[body].position.xyz;
  s.orientation = tensors[body].orientation;
  s.inverse_mass = velocity_of(i).w;
  if (s.inverse_mass == 0.0) return s;
  s.v = velocity_of(i).xyz;
  s.w = spin_of(i).xyz;
  float ahead = half_way(time_step, sub_step());
  s.ahead = ahead * tensors[body].velocity.xyz;
  s.ahead_turn = ahead * tensors[body].spin.xyz;
  s.moved = moved_of(i).xyz;
  s.turned = turned_of(i).xyz;
  s.tensor = tensors[body].diagonal.xyz;
  s.tensor_mixed = tensors[body].mixed.xyz;
  return s;
}

void keep_side(uint body, Side s) {
  if (s.inverse_mass == 0.0) return;
  uint i = body - world.bodies.x;
  velocity_of(i).xyz = s.v;
  spin_of(i).xyz = s.w;
}

#include "sphere/contact_place.h"
#include "sphere/contact_row.h"

SpherePair pair_at(uint o) { return pairs[list + order[world.pairs.x + o]]; }

// Of the manifold's contacts those that are solved.
#define FOR_CONTACTS(at, slot)                                                                           \
  for (uint i = 0u, n = solved_contacts(world, slot), at = first_contact(world, slot); i < n; \
       ++i, at = next_contact(world, at))

void prepare_manifold(uint o) {
  SpherePair pair = pair_at(o);
  Side a = side_of(pair.a), b = side_of(pair.b);
  FOR_CONTACTS(at, pair.slot) prepare(at, a, b);
  manifolds[world.pairs.x + pair.slot].state.y = 0u;
  spin_of(pair.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (pair.b != SPHERE_GROUND) spin_of(pair.b - world.bodies.x).w = 1.0;
}

#include "sphere/ball.h"

vec3 unit(vec3 v) { return dot(v, v) > 0.0 ? normalize(v) : vec3(0.0); }

// Contacts that press within a small patch of each other are that patch, not points or a line, and resist turns of one
// body against the other: an evenly pressed disk resists spin about its normal by 2/3 of its radius times friction
// (Contensou 1963), and is tipped over its rim by its radius times the force, the moment of rolling friction; a ball
// rolls freely. Where contacts lie farther apart, they do it themselves.
void resist_turn(SpherePair pair, inout Side a, inout Side b) {
  float impulse = 0.0;
  vec3 center = vec3(0.0), normal = vec3(0.0);
  FOR_CONTACTS(at, pair.slot) {
    Row row = row_of(contacts[at], a, b);
    impulse += row.impulse.x;
    center += row.impulse.x * row.ra;
    normal += row.impulse.x * row.normal;
  }
  if (impulse <= 0.0) return;
  center /= impulse;
  normal = unit(normal);
  vec3 turn = a.w - b.w;
  float spin = dot(normal, turn);
  vec3 tipping = turn - spin * normal, tip_axis = unit(tipping), across = cross(normal, tip_axis);
  float spread = 0.0, spread_across = 0.0;  // squares of lengths, times impulse
  FOR_CONTACTS(at, pair.slot) {
    Row row = row_of(contacts[at], a, b);
    vec3 off = row.ra - center;
    float side = dot(across, off);
    spread += row.impulse.x * dot(off, off);
    spread_across += row.impulse.x * side * side;
  }
  float radius = settings.patch_radius * world.gravity.w, widest = 4.0 * radius * radius * impulse;
  if (spread <= widest) resist(normal, spin, 2.0 / 3.0 * radius * friction_of(pair) * impulse, a, b);
  if (spread_across <= widest && !is_ball(pair.a) && !is_ball(pair.b))
    resist(tip_axis, dot(tip_axis, tipping), radius * impulse, a, b);
}

void solve_manifold(uint o, uint kind, float h) {
  SpherePair pair = pair_at(o);
  if (kind == SWEEP_BOUNCE && manifolds[world.pairs.x + pair.slot].state.y == 0u) return;
  Side a = side_of(pair.a), b = side_of(pair.b);
  if (kind == SWEEP_WARM_START) {
    FOR_CONTACTS(at, pair.slot) warm_start(at, a, b);
  } else if (kind == SWEEP_BOUNCE) {
    FOR_CONTACTS(at, pair.slot) bounce(at, restitution_of(pair), a, b);
  } else {
    if (kind == SWEEP_FIRST_PUSH) resist_turn(pair, a, b);
    FOR_CONTACTS(at, pair.slot) solve_normal(at, h, kind != SWEEP_RELAX, a, b);
    float friction = friction_of(pair);
    FOR_CONTACTS(at, pair.slot) solve_friction(at, friction, a, b);
  }
  keep_side(pair.a, a);
  if (pair.b != SPHERE_GROUND) keep_side(pair.b, b);
}

// Whether a contact of the manifold is to bounce.
bool bounces(uint o) {
  SpherePair pair = pair_at(o);
  if (restitution_of(pair) == 0.0) return false;
  Side a = side_of(pair.a), b = side_of(pair.b);
  bool any = false;
  FOR_CONTACTS(at, pair.slot) {
    Row row = row_of(contacts[at], a, b);
    any = any || row.impulse.w > 0.0 && struck(row, a, b);
  }
  if (any) manifolds[world.pairs.x + pair.slot].state.y = 1u;
  return any;
}

void keep_forces(uint o) {
  SpherePair pair = pair_at(o);
  bool bounced = manifolds[world.pairs.x + pair.slot].state.y == 1u;
  Side a = side_of(pair.a), b = side_of(pair.b);
  uint presses = 0u;
  FOR_CONTACTS(at, pair.slot) if (keep_force(at, bounced, a, b)) presses = 1u;
  manifolds[world.pairs.x + pair.slot].state.y = presses;
}

void integrate_velocity(uint i, float h) {
  if (velocity_of(i).w == 0.0) return;
  uint body = world.bodies.x + i;
  velocity_of(i).xyz += h * world.gravity.xyz;
  spin_of(i).xyz = gyrated(spin_of(i).xyz, states[body].orientation, shapes[bodies[body].ids.x], h);
}

void integrate_position(uint i, float h) {
  if (velocity_of(i).w == 0.0) return;
  moved_of(i).xyz += h * velocity_of(i).xyz;
  // Touched by nothing: exactly the parabola.
  if (spin_of(i).w == 0.0) moved_of(i).xyz -= 0.5 * h * h * world.gravity.xyz;
  turned_of(i).xyz += h * spin_of(i).xyz;
  uint body = world.bodies.x + i;
  states[body].orientation = normalize(quat_multiply(quat_of_turn(h * spin_of(i).xyz), states[body].orientation));
}

// Returns whether the body fell freely.
bool keep_body(uint i) {
  if (velocity_of(i).w == 0.0) return false;
  uint body = world.bodies.x + i;
  states[body].position.xyz += moved_of(i).xyz;
  states[body].velocity.xyz = velocity_of(i).xyz;
  states[body].spin.xyz = spin_of(i).xyz;
  return spin_of(i).w == 0.0;
}
