// Rows and impulses of a manifold's contacts when a step begins. Needs the bindings Settings, Progress, Bodies, States,
// Shapes, Tensors, Contacts, Order, Rows, Impulses, sphere/body.h, sphere/solve_step.h, and sphere/contact_row.h. Twin:
// prepare().
#include "shared/sphere/row.h"
#include "sphere/pair_material.h"
#include "sphere/ball.h"

// Where a body is when contacts were found, and half way through the step from there.
struct Start {
  vec3 position;
  vec4 orientation;
  Ahead ahead;
};

Start start_of_body(uint body) {
  Start s = Start(vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0), Ahead(vec3(0.0), vec3(0.0)));
  if (body == SPHERE_GROUND) return s;
  s.position = states[body].position.xyz;
  s.orientation = tensors[body].orientation;
  if (moves(body)) s.ahead = Ahead(plan.half_way * tensors[body].velocity.xyz, plan.half_way * tensors[body].spin.xyz);
  return s;
}

Side starting_side(uint body) {
  Side s = Side(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0));
  if (body == SPHERE_GROUND || !moves(body)) return s;
  return Side(tensors[body].velocity.xyz, tensors[body].spin.xyz, bodies[body].material.x, tensors[body].diagonal.xyz,
              tensors[body].mixed.xyz);
}

// Of a contact, when the step begins.
float approach_of(Row row, float gap, Side a, Side b) {
  float falls = float(b.inverse_mass > 0.0) - float(a.inverse_mass > 0.0);
  return speed_at_impact(dot(relative_velocity(row, a, b), row.normal), gap, falls * dot(row.normal, world.gravity.xyz));
}

// With the force of the last step as impulse of a sub-step. Returns the contact's approach.
float prepare_row(uint at, uint stride, SphereContact c, Start start_a, Start start_b, Side a, Side b) {
  bool of_a = (c.feature & SPHERE_SIDE_B) != 0u;  // the field is a's
  Row row;
  row.ra = rotate(start_a.orientation, c.anchor_a);
  row.rb = rotate(start_b.orientation, c.anchor_b);
  row.normal = rotate(of_a ? start_a.orientation : start_b.orientation, c.normal.xyz);
  float gap = dot(start_b.position + row.rb - start_a.position - row.ra, row.normal);
  go_half_way(of_a, start_a.ahead, start_b.ahead, row.ra, row.rb, row.normal);
  keep_row(at, stride, row, gap, a, b);
  float along = kept * plan.sub_step * c.force.x;
  vec3 friction = kept * plan.sub_step * c.force.yzw;
  impulses[at] = vec2(along, gap);
  keep_friction(at, stride, along > 0.0 ? friction - dot(friction, row.normal) * row.normal : vec3(0.0));
  keep_lasting(at, stride, along, false);
  return approach_of(row, gap, a, b);
}

// Rows, flags and friction of manifold o. What is hit gets levers of where its bodies are now by the first sweep.
void prepare_manifold(uint o) {
  SphereOrdered m = order[world.pairs.x + o];
  Start start_a = start_of_body(m.a), start_b = start_of_body(m.b);
  Side a = starting_side(m.a), b = starting_side(m.b);
  bool strikes = false;
  for (uint k = 0u; k < m.count; ++k) {
    uint at = SPHERE_ROW_PARTS * (world.rows.x + k * m.stride) + m.row;
    uint contact = SPHERE_MAX_CONTACTS * (world.pairs.x + m.slot) + k;
    float approach = prepare_row(at, m.stride, contacts[contact], start_a, start_b, a, b);
    contacts[contact].approach = approach;
    strikes = strikes || approach <= -settings.restitution_speed;
  }
  bool rolls = is_ball(m.a) || is_ball(m.b);  // the point where a ball touches does not turn with it
  m.flags = restitution_of(m) > 0.0 ? SPHERE_RESTITUTES : 0u;
  if (strikes) m.flags |= SPHERE_STRIKES | (rolls ? 0u : SPHERE_REFRESHED);
  order[world.pairs.x + o].flags = m.flags;
  order[world.pairs.x + o].friction = friction_between(m);
}
