// The pose of a body at the time within the step for which its contacts are found (StepPlan::contact_time). Lever arms
// and normals of contacts belong to that time as well. Twin: Placement. Needs the bindings Settings, States and
// sphere/body.h.
struct Placement {
  vec3 position;  // centre of mass (m)
  mat3 rotation;  // from body to world axes
};

Placement placement_of(uint body, float contact_time) {
  SphereState s = states[body];
  if (!moves(body)) return Placement(s.position.xyz, rotation_of(s.orientation));
  vec4 turned = normalize(quat_multiply(quat_of_turn(contact_time * s.spin.xyz), s.orientation));
  return Placement(s.position.xyz + contact_time * s.velocity.xyz, rotation_of(turned));
}
