// The distance between the two points of a contact at the present poses, and the speed at which it decreases. Needs the
// bindings States, Manifolds and Contacts, and sphere/body.h.

// Returns the normal of a contact at the present poses (unit vector from a to b, world axes).
vec3 normal_of(SphereContact c, SpherePair pair) {
  bool of_a = (c.feature & SPHERE_SIDE_B) != 0u;
  if (!of_a && pair.b == SPHERE_GROUND) return c.normal.xyz;
  return rotate(states[of_a ? pair.a : pair.b].orientation, c.normal.xyz);
}

// Returns the gap (m) of a contact along its normal at the present poses; negative if the bodies overlap.
float separation_of(SphereContact c, SpherePair pair) {
  vec3 on_a = states[pair.a].position.xyz + rotate(states[pair.a].orientation, c.anchor_a), on_b = c.anchor_b;
  if (pair.b != SPHERE_GROUND) on_b = states[pair.b].position.xyz + rotate(states[pair.b].orientation, on_b);
  return dot(on_b - on_a, normal_of(c, pair));
}

// Returns the velocity (m/s, world axes) of a point of a body; anchor: the point in body axes (m).
vec3 velocity_at(uint body, vec3 anchor) {
  if (body == SPHERE_GROUND || !moves(body)) return vec3(0.0);
  return states[body].velocity.xyz + cross(states[body].spin.xyz, rotate(states[body].orientation, anchor));
}

// Returns whether a contact closes its gap within `seconds`, and the bodies approach there by more than `least` (m).
bool strikes(SphereContact c, SpherePair pair, float seconds, float least) {
  vec3 nearing = velocity_at(pair.a, c.anchor_a) - velocity_at(pair.b, c.anchor_b);
  float approach = seconds * dot(nearing, normal_of(c, pair));
  return approach > least && approach > separation_of(c, pair);
}
