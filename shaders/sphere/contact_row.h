// One contact in the solve. Needs the bindings Settings, Bodies, States, Rows, a `world`, struct Side and
// shared/rotation.h.

const uint BOUNCE_SWEEPS = 12u;

vec3 tensor_times(Side s, vec3 v) { return symmetric_times(s.tensor, s.tensor_mixed, v); }

vec3 tangent_1(vec3 n) {
  if (abs(n.x) > 1e-5 * abs(n.z) || abs(n.y) > 1e-5 * abs(n.z)) return vec3(-n.y, n.x, 0.0) / length(n.xy);
  return vec3(0.0, -n.z, n.y) / length(n.yz);
}
vec3 tangent_2(vec3 n) { return cross(n, tangent_1(n)); }

float friction_of(SpherePair pair) {
  float other = pair.b == SPHERE_GROUND ? world.ground.x : bodies[pair.b].material.y;
  return sqrt(bodies[pair.a].material.y * other);
}
float restitution_of(SpherePair pair) {
  return max(bodies[pair.a].material.z, pair.b == SPHERE_GROUND ? world.ground.y : bodies[pair.b].material.z);
}

vec3 relative_velocity(SphereRow row, Side a, Side b) {
  return b.v + cross(b.w, row.rb.xyz) - a.v - cross(a.w, row.ra.xyz);
}

void apply(SphereRow row, vec3 impulse, inout Side a, inout Side b) {
  a.v -= a.inverse_mass * impulse;
  a.w -= tensor_times(a, cross(row.ra.xyz, impulse));
  b.v += b.inverse_mass * impulse;
  b.w += tensor_times(b, cross(row.rb.xyz, impulse));
}

float mass_along(vec3 direction, vec3 ra, vec3 rb, Side a, Side b) {
  vec3 ta = cross(ra, direction), tb = cross(rb, direction);
  float k = a.inverse_mass + b.inverse_mass + dot(ta, tensor_times(a, ta)) + dot(tb, tensor_times(b, tb));
  return k > 0.0 ? 1.0 / k : 0.0;
}

SphereRow prepared_row(SphereContact contact, SpherePair pair, Side a, Side b) {
  bool ground = pair.b == SPHERE_GROUND;
  vec3 ra = rotate(states[pair.a].orientation, contact.anchor_a.xyz), rb = contact.anchor_b.xyz, b_position = vec3(0.0);
  vec3 normal = contact.normal.xyz;
  if (!ground) {
    rb = rotate(states[pair.b].orientation, rb);
    b_position = states[pair.b].position.xyz;
  }
  if ((floatBitsToUint(contact.anchor_b.w) & SPHERE_SIDE_B) != 0u)
    normal = rotate(states[pair.a].orientation, normal);
  else if (!ground)
    normal = rotate(states[pair.b].orientation, normal);
  vec3 t1 = tangent_1(normal), t2 = tangent_2(normal);
  SphereRow row;
  row.ra = vec4(ra, dot(b_position + rb - states[pair.a].position.xyz - ra, normal));
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  row.rb = vec4(rb, min(mass_along(t1, ra, rb, a, b), mass_along(t2, ra, rb, a, b)));
  row.normal = vec4(normal, mass_along(normal, ra, rb, a, b));
  row.impulse = sub_step() * vec4(contact.anchor_a.w, dot(contact.friction.xyz, t1), dot(contact.friction.xyz, t2), 0.0);
  float approach = dot(relative_velocity(row, a, b), normal);
  row.bounce = vec4(approach, approach, 0.0, 0.0);
  return row;
}

void warm_start(uint at, inout Side a, inout Side b) {
  SphereRow row = rows[at];
  // What is about to strike gains speed until it does, but no more than gravity gives in a step.
  if (row.bounce.x < -settings.restitution_speed && row.impulse.w == 0.0) {
    float vn = dot(relative_velocity(row, a, b), row.normal.xyz);
    rows[at].bounce.x =
        min(row.bounce.x, max(vn, row.bounce.y - length(world.gravity.xyz) * settings.time_step));
  }
  vec3 normal = row.normal.xyz;
  apply(row, row.impulse.x * normal + row.impulse.y * tangent_1(normal) + row.impulse.z * tangent_2(normal), a, b);
}

// Way of a point of the body since contacts were found, to first order in the turn.
vec3 way_of(Side s, vec3 r) { return s.moved + cross(s.turned, r); }

// Sequential impulse, accumulated and clamped. With `push`, overlap is pushed out softly (implicit spring of frequency
// softness.x over a step h); without, the velocity that pushing left is taken back (relaxation).
void solve_normal(uint at, float h, bool push, inout Side a, inout Side b) {
  SphereRow row = rows[at];
  vec3 normal = row.normal.xyz;
  float separation = row.ra.w + dot(way_of(b, row.rb.xyz) - way_of(a, row.ra.xyz), normal), bias = 0.0, mass_scale = 1.0, impulse_scale = 0.0;
  if (separation > 0.0) {
    bias = separation / h;  // speculative: may close the distance, no more
  } else if (push) {
    float omega = 6.2831853 * softness.x, a1 = 2.0 * softness.y + h * omega, a2 = h * omega * a1;
    impulse_scale = 1.0 / (1.0 + a2);
    mass_scale = a2 * impulse_scale;
    float d = world.gravity.w;
    bias = max(omega / a1 * min(0.0, separation + softness.z * d), -settings.push_speed / softness.w * d);
  }
  float vn = dot(relative_velocity(row, a, b), normal);
  float total = max(row.impulse.x - row.normal.w * mass_scale * (vn + bias) - impulse_scale * row.impulse.x, 0.0);
  apply(row, (total - row.impulse.x) * normal, a, b);
  rows[at].impulse.x = total;
  rows[at].impulse.w = max(row.impulse.w, total);
  rows[at].bounce.z = separation;
}

void solve_friction(uint at, float friction, inout Side a, inout Side b) {
  SphereRow row = rows[at];
  vec3 t1 = tangent_1(row.normal.xyz), t2 = tangent_2(row.normal.xyz), v = relative_velocity(row, a, b);
  vec2 f = row.impulse.yz - row.rb.w * vec2(dot(v, t1), dot(v, t2));
  float most = friction * row.impulse.x, size = length(f);
  if (size > most) f *= most / size;
  vec2 change = f - row.impulse.yz;
  apply(row, change.x * t1 + change.y * t2, a, b);
  rows[at].impulse.yz = f;
}

// Whether a contact was struck fast enough to bounce: pressed, or closed by a blow that its neighbours took.
bool struck(SphereRow row) {
  if (row.bounce.x > -settings.restitution_speed) return false;
  return row.impulse.w > 0.0 || row.bounce.z < -row.bounce.x * sub_step();
}

void bounce(uint at, float restitution, inout Side a, inout Side b) {
  SphereRow row = rows[at];
  if (!struck(row)) return;
  float vn = dot(relative_velocity(row, a, b), row.normal.xyz);
  float total = max(row.impulse.x - row.normal.w * (vn + restitution * row.bounce.x), 0.0);
  apply(row, (total - row.impulse.x) * row.normal.xyz, a, b);
  rows[at].impulse.x = total;
}

// The gyroscopic term by the implicit midpoint rule on Euler's equations in the body frame. Both the kinetic energy
// and |L| are quadratic, so the rule keeps them (Hairer, Lubich, Wanner 2006, IV.2). Double precision: single would let
// |L| creep by a thousandth in ten thousand sub-steps.
vec3 gyrated(vec3 spin, vec4 orientation, SphereBody body, float h) {
  if (dot(spin, spin) * h * h < 1e-8) return spin;  // slower than 1e-4 rad a sub-step: the term is below rounding
  dvec4 q = normalize(dvec4(orientation));
  dvec3 t = 2.0 * cross(-q.xyz, dvec3(spin));
  dvec3 w0 = dvec3(spin) + q.w * t + cross(-q.xyz, t), w = w0;
  dmat3 inertia = dmat3(symmetric(body.inertia, body.inertia_mixed));
  dmat3 inverse_inertia = dmat3(symmetric(body.inverse_inertia, body.inverse_inertia_mixed));
  for (int i = 0; i < 6; ++i) {
    dvec3 mid = 0.5 * (w0 + w);
    w = w0 - double(h) * (inverse_inertia * cross(mid, inertia * mid));
  }
  t = 2.0 * cross(q.xyz, w);
  return vec3(w + q.w * t + cross(q.xyz, t));
}
