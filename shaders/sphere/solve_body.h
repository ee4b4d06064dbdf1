// Bodies in the solve: the work of one invocation on one body. Velocities are stored as sphere/solve_manifold.h states.
// Needs the bindings Settings, Progress, Bodies, Shapes, States and sphere/body.h.
#include "sphere/solve_step.h"

// The gyroscopic term by the implicit midpoint rule on Euler's equations in the body frame. Both the kinetic energy
// and |L| are quadratic, so the rule keeps them (Hairer, Lubich, Wanner 2006, IV.2). Only the change is turned back to
// world axes: turning all of the spin would let |L| creep by a thousandth in ten thousand sub-steps.
vec3 gyrated(vec3 spin, vec4 orientation, SphereShape shape, float h) {
  if (dot(spin, spin) * h * h < 1e-8) return spin;  // slower than 1e-4 rad a sub-step: the term is below rounding
  vec3 before = rotate(quat_conjugate(orientation), spin), change = vec3(0.0);
  for (int i = 0; i < 6; ++i) {
    vec3 mid = before + 0.5 * change, momentum = symmetric_times(shape.inertia.xyz, shape.inertia_mixed.xyz, mid);
    change = -h * symmetric_times(shape.inverse_inertia.xyz, shape.inverse_inertia_mixed.xyz, cross(mid, momentum));
  }
  return spin + rotate(orientation, change);
}

// Of a body, turns counted at its radius.
float speed_of(uint i) {
  float radius = shapes[bodies[world.bodies.x + i].ids.x].box_center.w;
  return sqrt(dot(velocity_of(i).xyz, velocity_of(i).xyz) + radius * radius * dot(spin_of(i).xyz, spin_of(i).xyz));
}

// sum += change, and what single precision is too coarse for stays in `rest` for the next time. In double
// precision: compilers may reorder an exact sum of floats.
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
  vec4 own = spin_of(i);  // whole, as others may have written its last component
  spin_of(i) = vec4(gyrated(own.xyz, states[body].orientation, shapes[bodies[body].ids.x], h), own.w);
}

// Friction that slips brakes evenly: with the speed that a sub-step ends with, a sliding part stops half a sub-step's travel
// too early. What holds, rolls or swings keeps its energy with that speed, and would gain some with the mean.
void integrate_position(uint i, float h) {
  if (velocity_of(i).w == 0.0) return;
  float slow = 4.0 * h * length(world.gravity.xyz);  // stops within a few sub-steps
  if (turned_of(i).w == 1.0 && moved_of(i).w > slow) h *= mean_share(moved_of(i).w, speed_of(i));
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
