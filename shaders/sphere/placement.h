// Where a body is halfway through the step: contacts are found there, and their levers and normals are of then. Twin:
// StepPlan::half_way, Placement. Needs the bindings Settings, States and sphere/body.h.
struct Placement {
  vec3 position;
  mat3 rotation;
};

Placement placement_of(uint body, float half_way) {
  SphereState s = states[body];
  if (!moves(body)) return Placement(s.position.xyz, rotation_of(s.orientation));
  vec4 turned = normalize(quat_multiply(quat_of_turn(half_way * s.spin.xyz), s.orientation));
  return Placement(s.position.xyz + half_way * s.velocity.xyz, rotation_of(turned));
}
