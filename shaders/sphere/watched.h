// The record of a body that WorldWatch (solver/world_watch.hpp) stores on the device (SphereWatched): positions from
// which displacement is measured, and kinetic energy. Needs the bindings Bodies, States, Shapes and Watched, and
// sphere/body.h.

bool is_watched(uint body) { return present(body) && bodies[body].material.x > 0.0; }

// Returns the displacement (m) of the centre of mass from a position with its remainder (`position_rest`).
vec3 shift_from(vec3 position, vec3 position_rest, SphereState s) {
  return (s.position.xyz - position) + (s.position_rest.xyz - position_rest);
}

// Returns the kinetic energy of a body (J).
float kinetic_of(uint body, SphereState s) {
  uint shape = bodies[body].ids.x;
  vec3 spin = rotate(quat_conjugate(s.orientation), s.spin.xyz);
  vec3 momentum = symmetric_times(shapes[shape].inertia.xyz, shapes[shape].inertia_mixed.xyz, spin);
  return 0.5 / bodies[body].material.x * (dot(s.velocity.xyz, s.velocity.xyz) + dot(spin, momentum));
}

// Returns an upper bound of the speed (m/s) of any point of a body.
float swiftness_of(uint body, SphereState s) {
  return length(s.velocity.xyz) + shapes[bodies[body].ids.x].box_center.w * length(s.spin.xyz);
}

void keep_before(uint body, SphereState s, float kinetic) {
  watched[body].before = vec4(s.position.xyz, kinetic);
  watched[body].before_rest = vec4(s.position_rest.xyz, length(s.velocity.xyz));
  watched[body].audited = vec4(swiftness_of(body, s), 1.0, 0.0, 0.0);
}

void keep_least(uint body, SphereState s, float kinetic, float swiftest) {
  watched[body].least = vec4(s.position.xyz, kinetic);
  watched[body].least_rest = vec4(s.position_rest.xyz, swiftest);
}
