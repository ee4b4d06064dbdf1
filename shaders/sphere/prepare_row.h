// Prepares the contacts of a manifold at the beginning of a step: their rows (lever arms, effective masses) and their
// initial impulses, which are those of the last step. Twin: prepare(). Needs the bindings Settings, Progress, Bodies,
// States, Shapes, Tensors, Contacts, Order, Rows, Impulses, sphere/body.h, sphere/solve_step.h, and
// sphere/contact_row.h.
#include "shared/sphere/row.h"
#include "sphere/near.h"
#include "sphere/ordered.h"
#include "sphere/pair_material.h"
#include "sphere/ball.h"

// The pose of a body at the start of the step, and its motion from there to the contact time (StepPlan::contact_time).
struct Start {
  vec3 position;     // centre of mass (m)
  vec4 orientation;  // x, y, z, w; from body to world axes
  Ahead ahead;
};

Start start_of_body(uint body) {
  Start s = Start(vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0), Ahead(vec3(0.0), vec3(0.0)));
  if (body == SPHERE_GROUND) return s;
  s.position = states[body].position.xyz;
  s.orientation = tensors[body].orientation;
  if (moves(body)) s.ahead = Ahead(plan.contact_time * tensors[body].velocity.xyz, plan.contact_time * tensors[body].spin.xyz);
  return s;
}

Side starting_side(uint body) {
  if (body == SPHERE_GROUND || !moves(body)) return Side(vec3(0.0), 0.0, vec3(0.0), vec3(0.0));
  return Side(tensors[body].spin.xyz, bodies[body].material.x, tensors[body].diagonal.xyz, tensors[body].mixed.xyz);
}

Sides starting_sides(Members of) {
  Sides s = Sides(starting_side(of.a), starting_side(of.b), vec3(0.0));
  if (s.b.inverse_mass > 0.0) s.between = tensors[of.b].velocity.xyz;
  if (s.a.inverse_mass > 0.0) s.between -= tensors[of.a].velocity.xyz;
  return s;
}

// Returns whether nothing holds a body up. What has not moved lately, such as a part that an impact has woken, is held.
bool falls_freely(uint body) { return body != SPHERE_GROUND && moves(body) && states[body].still_position.w == 0.0; }

// Returns the speed (m/s, negative) at which a contact closes its gap (m), at the velocities of the start of the step.
// falls: 1 if only b falls freely, -1 if only a does, otherwise 0.
float approach_of(Row row, float gap, Sides s, float falls) {
  return speed_at_impact(dot(relative_velocity(row, s), row.normal), gap, falls * dot(row.normal, world.gravity.xyz));
}

// Returns the squared length of a lever arm (m2), or 0 if the body cannot move.
float length_squared(Side side, vec3 lever) { return side.inverse_mass > 0.0 ? dot(lever, lever) : 0.0; }

// Stores the row of a contact, and its force of the last step as impulse of a sub-step. Returns its approach (m/s).
float prepare_row(uint at, uint stride, SphereContact c, Start start_a, Start start_b, Sides s, float falls) {
  bool of_a = (c.feature & SPHERE_SIDE_B) != 0u;  // the normal belongs to a
  Row row;
  row.ra = rotate(start_a.orientation, c.anchor_a);
  row.rb = rotate(start_b.orientation, c.anchor_b);
  row.normal = rotate(of_a ? start_a.orientation : start_b.orientation, c.normal.xyz);
  float gap = dot(start_b.position + row.rb - start_a.position - row.ra, row.normal);
  move_to_contact_time(of_a, start_a.ahead, start_b.ahead, row.ra, row.rb, row.normal);
  keep_row(at, stride, row, gap, s);
  float along = kept * plan.sub_step * c.force.x;
  vec3 friction = kept * plan.sub_step * c.force.yzw;
  impulses[at] = vec2(along, gap);
  keep_friction(at, stride, along > 0.0 ? friction - dot(friction, row.normal) * row.normal : vec3(0.0));
  keep_lasting(at, stride, along, false);
  return approach_of(row, gap, s, falls);
}

// Determines which contacts of a manifold may press in the first sub-step. If one of them strikes, all may. reach: m,
// largest displacement along a normal in a sub-step.
void find_first_near(uint first_row, uint stride, float reach, bool strikes, inout SphereOrdered m) {
  uint near = 0u, count = count_of(m.kind);
  m.slack = NO_LIMIT;
  for (uint k = 0u; k < count; ++k) {
    vec2 impulse = impulses[first_row + SPHERE_ROW_PARTS * k * stride];  // y: gap
    if (strikes || impulse.x > 0.0 || !(impulse.y > NEAR_REACH * reach))
      near |= 1u << k;
    else
      m.slack = min(m.slack, impulse.y);
  }
  m.kind = with_near(m.kind, near);
}

// Prepares the rows of manifold o, and its members of SphereOrdered that sweeps read.
void prepare_manifold(uint o) {
  SphereOrdered m = order[world.pairs.x + o];
  Members of = bodies_of(world, m.bodies);
  Start start_a = start_of_body(of.a), start_b = start_of_body(of.b);
  Sides s = starting_sides(of);
  uint count = count_of(m.kind), stride = stride_of(m.kind), first = SPHERE_ROW_PARTS * world.rows.x + m.row;
  bool strikes = false;
  float falls = float(falls_freely(of.b)) - float(falls_freely(of.a));
  float arm_squared = 0.0, least_mass = NO_LIMIT;
  for (uint k = 0u; k < count; ++k) {
    uint at = first + SPHERE_ROW_PARTS * k * stride, contact = SPHERE_MAX_CONTACTS * (world.pairs.x + m.slot) + k;
    float approach = prepare_row(at, stride, contacts[contact], start_a, start_b, s, falls);
    contacts[contact].approach = approach;
    Row row = row_at(at, stride);
    arm_squared = max(arm_squared, max(length_squared(s.a, row.ra), length_squared(s.b, row.rb)));
    least_mass = min(least_mass, row.normal_mass);
    strikes = strikes || approach <= -settings.restitution_speed;
  }
  bool rolls = is_ball(of.a) || is_ball(of.b);  // the contact point of a ball does not rotate with the ball
  if (restitution_of(of) > 0.0) m.kind |= SPHERE_RESTITUTES;
  if (strikes) m.kind |= SPHERE_STRIKES | (rolls ? 0u : SPHERE_REFRESHED);
  m.friction = friction_between(of);
  m.arm = sqrt(arm_squared);
  m.yield = yield_of(least_mass);
  float reach = reach_of(s.between, s.a.w, s.b.w, m.arm);
  find_first_near(first, stride, plan.sub_step * reach, strikes, m);
  order[world.pairs.x + o] = m;
}
