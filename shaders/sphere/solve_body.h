// The work of one invocation on one body in the solve. sphere/solve_manifold.h states how velocities are stored.
// Needs the bindings Settings, Progress, Bodies, Shapes, States and sphere/body.h.
#include "sphere/solve_step.h"
#include "shared/sphere/gyroscope.h"

// Returns the change of the angular velocity over h seconds in the body frame, by the implicit midpoint rule for Euler's
// equations. It conserves the energy and the length of the angular momentum. Twin: gyroscope.hpp.
vec3 gyroscopic_change(vec3 spin, vec4 orientation, SphereShape shape, float h) {
  vec3 before = rotate(quat_conjugate(orientation), spin), change = vec3(0.0);
  for (int i = 0; i < 6; ++i) {
    vec3 mid = before + 0.5 * change, momentum = symmetric_times(shape.inertia.xyz, shape.inertia_mixed.xyz, mid);
    change = -h * symmetric_times(shape.inverse_inertia.xyz, shape.inverse_inertia_mixed.xyz, cross(mid, momentum));
  }
  return change;
}

// Whether the gyroscopic torque is more than rounding.
bool gyrates(uint i, float h) { return dot(spin_of(i).xyz, spin_of(i).xyz) * h * h >= LEAST_GYRATION * LEAST_GYRATION; }

// Whether bodies that nothing touches turn by turn_freely(), and not with the spin after the sub-step: in worlds that
// solve impacts exactly, because the poses of the parts were given.
bool turns_exactly() { return world.tolerance.z > 0.0; }

vec4 turned_by(vec3 turn, vec4 orientation) { return normalize(quat_multiply(quat_of_turn(turn), orientation)); }

// Turns body i, which nothing touches, for h seconds. Half of the change of its spin comes before the rotation, so that
// it turns with the mean spin: this conserves the direction of the angular momentum as well. Only changes are rotated
// to world axes: otherwise, rounding would change |L| by a thousandth in ten thousand sub-steps.
void turn_freely(uint i, float h) {
  uint body = world.bodies.x + i;
  SphereShape shape = shapes[bodies[body].ids.x];
  vec4 orientation = states[body].orientation;
  vec3 w = spin_of(i).xyz;
  int steps = steps_of_free_turn(length(w) * h);
  h /= float(steps);
  for (int k = 0; k < steps; ++k) {
    vec3 half_change = 0.5 * gyroscopic_change(w, orientation, shape, h * time_of_free_turn(length(w) * h));
    w += rotate(orientation, half_change);
    orientation = turned_by(h * w, orientation);
    w += rotate(orientation, half_change);
  }
  states[body].orientation = orientation;
  spin_of(i) = vec4(w, 0.0);
}

// Returns the speed (m/s) of body i: root of the squared velocity + squared (angular velocity x radius).
float speed_of(uint i) {
  float radius = shapes[bodies[world.bodies.x + i].ids.x].box_center.w;
  return sqrt(dot(velocity_of(i).xyz, velocity_of(i).xyz) + radius * radius * dot(spin_of(i).xyz, spin_of(i).xyz));
}

// Adds `change` to `sum`, and stores the remainder that single precision loses in `rest` for the next call. Double
// precision is used because compilers may reorder a compensated sum of floats.
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
  if (turns_exactly() && spin_of(i).w == 0.0 || !gyrates(i, h)) return;  // integrate_position() turns it
  vec4 own = spin_of(i), orientation = states[body].orientation;
  vec3 change = gyroscopic_change(own.xyz, orientation, shapes[bodies[body].ids.x], h);
  spin_of(i) = vec4(own.xyz + rotate(orientation, change), own.w);
}

// Moves body i for h seconds. Sliding friction brakes steadily: with the speed at the end of a sub-step, a sliding part
// would stop too early, so that its mean speed is used. Parts that stick, roll or swing would gain energy by that.
void integrate_position(uint i, float h) {
  if (velocity_of(i).w == 0.0) return;
  float slow = 4.0 * h * length(world.gravity.xyz);  // m/s: a slower body stops within a few sub-steps
  if (turned_of(i).w == 1.0 && moved_of(i).w > slow) h *= mean_share(moved_of(i).w, speed_of(i));
  moved_of(i).xyz += h * velocity_of(i).xyz;
  bool flies = spin_of(i).w == 0.0;  // without near contacts: it follows the parabola of free fall exactly
  if (flies) moved_of(i).xyz -= 0.5 * h * h * world.gravity.xyz;
  turned_of(i).xyz += h * spin_of(i).xyz;
  uint body = world.bodies.x + i;
  if (turns_exactly() && flies && gyrates(i, h))
    turn_freely(i, h);
  else
    states[body].orientation = turned_by(h * spin_of(i).xyz, states[body].orientation);
}

// Stores the pose and the velocity of body i at the end of the step. Returns whether the body fell freely.
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
