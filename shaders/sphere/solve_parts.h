// Bodies and manifolds in the solve: what one invocation does with one of them. Whoever includes this says where
// velocities lie: velocity_of(i) (w: inverse mass, 0 = nothing moves it in this step), spin_of(i) (w: 1 = a contact is
// near), moved_of(i) (since contacts were found; w: speed when the sub-step began), turned_of(i) (rotation vector, since
// then; w: 1 = a contact slips), i counted in the world.
// Needs the bindings Settings, Progress, Bodies, Shapes, States, Tensors, Pairs, Manifolds, Contacts, Order, and
// sphere/body.h.

#include "shared/language.h"
#include "shared/sphere/blow.h"
#include "sphere/ball.h"
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
  vec4 orientation, now;   // when contacts were found, and after the turn since
  float inverse_mass;
  vec3 tensor, tensor_mixed;
};

const vec4 no_turn = vec4(0.0, 0.0, 0.0, 1.0);

Side side_of(uint body) {
  Side s = Side(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), no_turn, no_turn, 0.0,
                vec3(0.0), vec3(0.0));
  if (body == SPHERE_GROUND) return s;
  uint i = body - world.bodies.x;
  s.position = states[body].position.xyz;
  s.orientation = s.now = tensors[body].orientation;
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

// The same of a manifold that is struck: its levers, gaps and inertia are of where its bodies are now. With those of half
// way through the step a blow would turn each of two bodies about a lever that is up to half a step's way off.
bool aimed = false;

// Not with a ball: the point where it touches does not turn with it.
bool aims(SpherePair pair) {
  return manifolds[world.pairs.x + pair.slot].state.y != 0u && !is_ball(pair.a) && !is_ball(pair.b);
}

Side aimed_side_of(uint body) {
  Side s = side_of(body);
  if (!aimed || s.inverse_mass == 0.0) return s;
  s.now = normalize(quat_multiply(quat_of_turn(s.turned), s.orientation));
  uint shape = bodies[body].ids.x;
  mat3 r = rotation_of(s.now);
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

#include "sphere/contact_place.h"
#include "sphere/contact_row.h"

SpherePair pair_at(uint o) { return pairs[list + order[world.pairs.x + o]]; }

// Of the manifold's contacts those that are solved.
#define FOR_CONTACTS(at, slot)                                                                           \
  for (uint i = 0u, n = solved_contacts(world, slot), at = first_contact(world, slot); i < n; \
       ++i, at = next_contact(world, at))

void prepare_manifold(uint o) {
  SpherePair pair = pair_at(o);
  aimed = false;
  Side a = side_of(pair.a), b = side_of(pair.b);
  bool strikes = false;
  FOR_CONTACTS(at, pair.slot) strikes = prepare(at, a, b) || strikes;
  manifolds[world.pairs.x + pair.slot].state.y = strikes ? SPHERE_STRIKES : 0u;
  spin_of(pair.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (pair.b != SPHERE_GROUND) spin_of(pair.b - world.bodies.x).w = 1.0;
}

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
  uint blow = manifolds[world.pairs.x + pair.slot].state.y;
  if (kind == SWEEP_BOUNCE && blow != SPHERE_BOUNCES) return;
  aimed = aims(pair);
  Side a = aimed_side_of(pair.a), b = aimed_side_of(pair.b);
  if (kind == SWEEP_WARM_START) {
    float restitution = restitution_of(pair);
    FOR_CONTACTS(at, pair.slot) warm_start(at, restitution, a, b);
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
  aimed = aims(pair);
  Side a = aimed_side_of(pair.a), b = aimed_side_of(pair.b);
  bool any = false;
  FOR_CONTACTS(at, pair.slot) {
    Row row = row_of(contacts[at], a, b);
    any = any || has_pressed(row.impulse) && struck(row, a, b);
  }
  if (any) manifolds[world.pairs.x + pair.slot].state.y = SPHERE_BOUNCES;
  return any;
}

void keep_forces(uint o) {
  SpherePair pair = pair_at(o);
  uint blow = manifolds[world.pairs.x + pair.slot].state.y;
  bool bounced = blow == SPHERE_BOUNCES;
  aimed = aims(pair);
  Side a = aimed_side_of(pair.a), b = aimed_side_of(pair.b);
  uint presses = 0u;
  float restitution = restitution_of(pair);
  FOR_CONTACTS(at, pair.slot) if (keep_force(at, restitution, bounced, a, b)) presses = 1u;
  manifolds[world.pairs.x + pair.slot].state.y = presses;
}

// Bodies with a contact that has all the friction that its force allows.
void note_sliding(uint o) {
  SpherePair pair = pair_at(o);
  float friction = friction_of(pair);
  bool slips = false;
  FOR_CONTACTS(at, pair.slot) {
    vec3 impulse = contacts[at].force.xyz;
    float most = friction * impulse.x;
    slips = slips || most > 0.0 && dot(impulse.yz, impulse.yz) > 0.999 * most * most;
  }
  if (!slips) return;
  turned_of(pair.a - world.bodies.x).w = 1.0;  // all that come here write the same
  if (pair.b != SPHERE_GROUND) turned_of(pair.b - world.bodies.x).w = 1.0;
}

// Of a body, turns counted at its radius.
float speed_of(uint i) {
  float radius = shapes[bodies[world.bodies.x + i].ids.x].box_center.w;
  return sqrt(dot(velocity_of(i).xyz, velocity_of(i).xyz) + radius * radius * dot(spin_of(i).xyz, spin_of(i).xyz));
}

// sum += change, and what single precision is too coarse for stays in `rest` for the next time. In double precision: with
// the exact sum of floats the layouts of small and of large worlds round apart.
void add_exactly(vec3 change, inout vec3 sum, inout vec3 rest) {
  dvec3 exact = dvec3(sum) + (dvec3(rest) + dvec3(change));
  sum = vec3(exact);
  rest = vec3(exact - dvec3(sum));
}

void integrate_velocity(uint i, float h) {
  if (velocity_of(i).w == 0.0) return;
  uint body = world.bodies.x + i;
  moved_of(i).w = speed_of(i);
  turned_of(i).w = 0.0;
  vec3 v = velocity_of(i).xyz, rest = states[body].velocity_rest.xyz;
  add_exactly(h * world.gravity.xyz, v, rest);
  velocity_of(i).xyz = v;
  states[body].velocity_rest.xyz = rest;
  spin_of(i).xyz = gyrated(spin_of(i).xyz, states[body].orientation, shapes[bodies[body].ids.x], h);
}

// Mean speed of a sub-step / speed at its end, of a body that friction brakes all the while: 1 of what is struck, or as
// slow as it is braked in a sub-step.
float mean_speed(uint i) {
  float before = moved_of(i).w, after = speed_of(i);
  return after > 0.5 * before && after < 2.0 * before ? 0.5 * (before / after + 1.0) : 1.0;
}

// Friction that slips brakes evenly: with the speed that a sub-step ends with, a sliding part stops half a sub-step's way
// too early. What holds, rolls or swings keeps its energy with that speed, and would gain some with the mean.
void integrate_position(uint i, float h) {
  if (velocity_of(i).w == 0.0) return;
  float slow = 4.0 * h * length(world.gravity.xyz);  // stops within a few sub-steps
  if (turned_of(i).w == 1.0 && moved_of(i).w > slow) h *= mean_speed(i);
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
  vec3 position = states[body].position.xyz, rest = states[body].position_rest.xyz;
  add_exactly(moved_of(i).xyz, position, rest);
  states[body].position.xyz = position;
  states[body].position_rest.xyz = rest;
  states[body].velocity.xyz = velocity_of(i).xyz;
  states[body].spin.xyz = spin_of(i).xyz;
  return spin_of(i).w == 0.0;
}
