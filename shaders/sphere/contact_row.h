// One contact in the solve. Needs the bindings Settings, Bodies, Contacts, a `world`, `softness`, `grip`, `kept`,
// `aimed`, struct Side, shared/rotation.h and shared/sphere/blow.h.

vec3 tensor_times(Side s, vec3 v) { return symmetric_times(s.tensor, s.tensor_mixed, v); }

vec3 tangent_1(vec3 n) {
  if (abs(n.x) > 1e-5 * abs(n.z) || abs(n.y) > 1e-5 * abs(n.z)) return vec3(-n.y, n.x, 0.0) / length(n.xy);
  return vec3(0.0, -n.z, n.y) / length(n.yz);
}
vec3 tangent_2(vec3 n) { return cross(n, tangent_1(n)); }

float friction_of(SpherePair pair) {
  float other = pair.b == SPHERE_GROUND ? world.ground.x : bodies[pair.b].material.y;
  return grip * sqrt(bodies[pair.a].material.y * other);
}
float restitution_of(SpherePair pair) {
  return max(bodies[pair.a].material.z, pair.b == SPHERE_GROUND ? world.ground.y : bodies[pair.b].material.z);
}

// A contact in world terms. Made from the contact whenever it is touched: kept, it would take as many bytes again.
struct Row {
  vec3 ra, rb, normal;
  float separation;
  float approach;
  vec4 impulse;  // as in SphereContact.force
};

vec3 relative_velocity(Row row, Side a, Side b) {
  return b.v + cross(b.w, row.rb) - a.v - cross(a.w, row.ra);
}

void apply(Row row, vec3 impulse, inout Side a, inout Side b) {
  a.v -= a.inverse_mass * impulse;
  a.w -= tensor_times(a, cross(row.ra, impulse));
  b.v += b.inverse_mass * impulse;
  b.w += tensor_times(b, cross(row.rb, impulse));
}

float mass_along(vec3 direction, Row row, Side a, Side b) {
  vec3 ta = cross(row.ra, direction), tb = cross(row.rb, direction);
  float k = a.inverse_mass + b.inverse_mass + dot(ta, tensor_times(a, ta)) + dot(tb, tensor_times(b, tb));
  return k > 0.0 ? 1.0 / k : 0.0;
}

// Levers and normals are of the mean of the sub-steps' beginnings: those of the step's start turn what hangs into what
// gains energy. The point goes with the sample, the normal with the field.
const float least_turn = 1e-5;  // rad; below, a lever moves by less than contacts overlap

// Way of a point of the body since contacts were found, to first order in the turn.
vec3 way_of(Side s, vec3 r) { return s.moved + cross(s.turned, r); }
float separation_of(Row row, Side a, Side b) {
  return row.separation + dot(way_of(b, row.rb) - way_of(a, row.ra), row.normal);
}

// Levers of one common point where the bodies are now.
void aim(SphereContact c, Side a, Side b, inout Row row) {
  vec3 x_a = a.position + a.moved, x_b = b.position + b.moved;
  vec3 on_a = x_a + rotate(a.now, c.anchor_a), on_b = x_b + rotate(b.now, c.anchor_b);
  vec3 between = on_b - on_a, middle = on_a + 0.5 * between;
  row.ra = middle - x_a;
  row.rb = middle - x_b;
  row.separation = 0.0;
  row.separation = dot(between, row.normal) - separation_of(row, a, b);
}

Row row_of(SphereContact c, Side a, Side b) {
  Row row;
  row.ra = rotate(a.orientation, c.anchor_a);
  row.rb = rotate(b.orientation, c.anchor_b);
  bool of_a = (c.feature & SPHERE_SIDE_B) != 0u;
  row.normal = rotate(of_a ? a.orientation : b.orientation, c.normal.xyz);
  row.separation = dot(b.position + row.rb - a.position - row.ra, row.normal);
  if (max(dot(a.ahead_turn, a.ahead_turn), dot(b.ahead_turn, b.ahead_turn)) > least_turn * least_turn) {
    vec3 way = of_a ? b.ahead + cross(b.ahead_turn, row.rb) : a.ahead + cross(a.ahead_turn, row.ra);
    row.ra += way - a.ahead;
    row.rb += way - b.ahead;
    row.normal = normalize(row.normal + cross(of_a ? a.ahead_turn : b.ahead_turn, row.normal));
  }
  row.approach = c.normal.w;
  row.impulse = c.force;
  if (aimed) aim(c, a, b, row);
  return row;
}

// Speed along the normal when the gap of a contact that closes (below 0) has closed: gravity works on what moves, and a
// blow returns neither more nor less than what has come down.
float speed_at_blow(Row row, Side a, Side b) {
  float speed = dot(relative_velocity(row, a, b), row.normal);
  float falls = float(b.inverse_mass > 0.0) - float(a.inverse_mass > 0.0);
  float square = speed * speed - 2.0 * falls * dot(row.normal, world.gravity.xyz) * max(row.separation, 0.0);
  return speed < 0.0 ? -sqrt(max(square, 0.0)) : speed;
}

// Returns whether the contact is struck.
bool prepare(uint at, Side a, Side b) {
  Row row = row_of(contacts[at], a, b);
  vec3 t1 = tangent_1(row.normal), t2 = tangent_2(row.normal), friction = row.impulse.yzw;
  contacts[at].normal.w = speed_at_blow(row, a, b);
  vec3 impulse = kept * sub_step() * vec3(row.impulse.x, dot(friction, t1), dot(friction, t2));
  contacts[at].force = vec4(impulse, impulse.x);
  return contacts[at].normal.w <= -settings.restitution_speed;
}

bool has_pressed(vec4 impulse) { return (floatBitsToUint(impulse.w) & 0x80000000u) != 0u; }

// Takes from an impulse what was a blow (shared/sphere/blow.h). What bounces keeps the impulse of its blow, which the
// bounce may have to take back, until it has bounced.
void forget_blow(float restitution, inout Row row, Side a, Side b) {
  if (restitution > 0.0 && row.approach <= -settings.restitution_speed) return;
  float speed = blow_speed(sub_step(), length(world.gravity.xyz), settings.restitution_speed);
  float most = FORCE_GROWTH * abs(row.impulse.w) + speed * mass_along(row.normal, row, a, b);
  if (row.impulse.x > most) row.impulse.xyz *= most / row.impulse.x;
}

void warm_start(uint at, float restitution, inout Side a, inout Side b) {
  Row row = row_of(contacts[at], a, b);
  forget_blow(restitution, row, a, b);
  uint pressed = floatBitsToUint(row.impulse.w) & 0x80000000u;
  contacts[at].force = vec4(row.impulse.xyz, uintBitsToFloat(floatBitsToUint(row.impulse.x) | pressed));
  vec3 normal = row.normal;
  apply(row, row.impulse.x * normal + row.impulse.y * tangent_1(normal) + row.impulse.z * tangent_2(normal), a, b);
}

// Takes a turn of one body against the other about an axis, by a moment of at most `most`.
void resist(vec3 axis, float speed, float most, inout Side a, inout Side b) {
  vec3 turn_a = tensor_times(a, axis), turn_b = tensor_times(b, axis);
  float k = dot(axis, turn_a) + dot(axis, turn_b);
  float moment = k > 0.0 ? clamp(speed / k, -most, most) : 0.0;
  a.w -= moment * turn_a;
  b.w += moment * turn_b;
}

// Sequential impulse, accumulated and clamped. With `push`, overlap is pushed out softly (implicit spring of frequency
// softness.x / h over a step h); without, the velocity that pushing left is taken back (relaxation).
void solve_normal(uint at, float h, bool push, inout Side a, inout Side b) {
  Row row = row_of(contacts[at], a, b);
  float separation = separation_of(row, a, b), bias = 0.0, mass_scale = 1.0, impulse_scale = 0.0;
  if (separation > 0.0) {
    bias = separation / h;  // speculative: may close the distance, no more
  } else if (push) {
    float omega = 6.2831853 * softness.x / h, a1 = 2.0 * softness.y + h * omega, a2 = h * omega * a1;
    impulse_scale = 1.0 / (1.0 + a2);
    mass_scale = a2 * impulse_scale;
    float d = world.gravity.w;
    bias = max(omega / a1 * min(0.0, separation + softness.z * d), -settings.push_speed / softness.w * d);
  }
  float vn = dot(relative_velocity(row, a, b), row.normal);
  float mass = mass_scale * mass_along(row.normal, row, a, b);
  float total = max(row.impulse.x - mass * (vn + bias) - impulse_scale * row.impulse.x, 0.0);
  apply(row, (total - row.impulse.x) * row.normal, a, b);
  contacts[at].force.x = total;
  if (total > 0.0) contacts[at].force.w = uintBitsToFloat(floatBitsToUint(row.impulse.w) | 0x80000000u);
}

void solve_friction(uint at, float friction, inout Side a, inout Side b) {
  Row row = row_of(contacts[at], a, b);
  vec3 t1 = tangent_1(row.normal), t2 = tangent_2(row.normal), v = relative_velocity(row, a, b);
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  float mass = min(mass_along(t1, row, a, b), mass_along(t2, row, a, b));
  vec2 f = row.impulse.yz - mass * vec2(dot(v, t1), dot(v, t2));
  float most = friction * row.impulse.x, size = length(f);
  if (size > most) f *= most / size;
  vec2 change = f - row.impulse.yz;
  apply(row, change.x * t1 + change.y * t2, a, b);
  contacts[at].force.yz = f;
}

// Whether a contact was struck fast enough to bounce: pressed, or closed by a blow that its neighbours took.
bool struck(Row row, Side a, Side b) {
  if (row.approach > -settings.restitution_speed) return false;
  return has_pressed(row.impulse) || separation_of(row, a, b) < -row.approach * sub_step();
}

void bounce(uint at, float restitution, inout Side a, inout Side b) {
  Row row = row_of(contacts[at], a, b);
  if (!struck(row, a, b)) return;
  float vn = dot(relative_velocity(row, a, b), row.normal);
  float mass = mass_along(row.normal, row, a, b);
  float total = max(row.impulse.x - mass * (vn + restitution * row.approach), 0.0);
  apply(row, (total - row.impulse.x) * row.normal, a, b);
  contacts[at].force.x = total;
}

// Back to forces; returns whether the contact presses. A blow is over: it must not warm-start the next step.
bool keep_force(uint at, float restitution, bool bounced, Side a, Side b) {
  Row row = row_of(contacts[at], a, b);
  if (bounced && struck(row, a, b)) row.impulse = vec4(0.0);
  forget_blow(restitution, row, a, b);
  vec3 friction = row.impulse.y * tangent_1(row.normal) + row.impulse.z * tangent_2(row.normal);
  contacts[at].force = vec4(row.impulse.x, friction) / sub_step();
  return row.impulse.x > 0.0;
}

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
