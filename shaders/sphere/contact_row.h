// One contact in the solve: a row, made once a step (prepare_row), and what sweeps do with it. The row of contact k of a
// manifold begins at rows[at]; its parts lie `stride` behind each other (shared/sphere.h). Needs the bindings Settings,
// Bodies, Rows, a `world`, `spring`, `restless`, struct Side, shared/rotation.h and shared/sphere/blow.h.

vec3 tensor_times(Side s, vec3 v) { return symmetric_times(s.tensor, s.tensor_mixed, v); }

// The first tangent is (-y, x, 0) times scale; of a normal along z, with a scale below 0, (0, z, -y) times it.
float tangent_scale(vec3 n) {
  if (abs(n.x) > 1e-5 * abs(n.z) || abs(n.y) > 1e-5 * abs(n.z)) return 1.0 / length(n.xy);
  return -1.0 / length(n.yz);
}
vec3 tangent_of(vec3 n, float scale) { return scale * (scale > 0.0 ? vec3(-n.y, n.x, 0.0) : vec3(0.0, n.z, -n.y)); }

// What a sweep reads of a row.
struct Row {
  vec3 ra, rb, normal, tangent;  // levers from the centres of mass (m); the second tangent is normal x tangent
  float gap, normal_mass, tangent_mass;
  vec3 impulse;                  // of one sub-step (N s): normal, two of friction
};

Row row_at(uint at, uint stride) {
  vec4 a = rows[at], b = rows[at + stride], n = rows[at + 2u * stride], i = rows[at + 3u * stride];
  return Row(a.xyz, b.xyz, n.xyz, tangent_of(n.xyz, n.w), a.w, b.w, i.w, i.xyz);
}

// What few sweeps read.
struct Blow {
  float separation;  // when contacts were found (m)
  float approach;    // speed at which the two meet if they do in this step (m/s), negative: closing
  float lasting;     // normal impulse that the sub-step began with (N s)
  float pressed;     // 1: it has pressed in this step
};

Blow blow_at(uint at, uint stride) {
  vec4 v = rows[at + 4u * stride];
  return Blow(v.x, v.y, v.z, v.w);
}

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

// Masses from levers, normal and inertia; keeps what depends on where the bodies are.
void keep_levers(uint at, uint stride, Row row, Side a, Side b) {
  vec3 t2 = cross(row.normal, row.tangent);
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  float tangent_mass = min(mass_along(row.tangent, row, a, b), mass_along(t2, row, a, b));
  rows[at] = vec4(row.ra, row.gap);
  rows[at + stride] = vec4(row.rb, mass_along(row.normal, row, a, b));
  rows[at + 3u * stride].w = tangent_mass;
}

// Speed along the normal when the gap of a contact that closes (below 0) has closed: gravity works on what moves, and a
// blow returns neither more nor less than what has come down.
float speed_at_blow(Row row, Side a, Side b) {
  float speed = dot(relative_velocity(row, a, b), row.normal);
  float falls = float(b.inverse_mass > 0.0) - float(a.inverse_mass > 0.0);
  float square = speed * speed - 2.0 * falls * dot(row.normal, world.gravity.xyz) * max(row.gap, 0.0);
  return speed < 0.0 ? -sqrt(max(square, 0.0)) : speed;
}

// Takes from an impulse what was a blow (shared/sphere/blow.h). What bounces keeps the impulse of its blow, which the
// bounce may have to take back, until it has bounced.
vec3 without_blow(Row row, Blow blow, bool restitutes) {
  if (restitutes && blow.approach <= -settings.restitution_speed) return row.impulse;
  float speed = blow_speed(sub_step(), length(world.gravity.xyz), settings.restitution_speed);
  float most = FORCE_GROWTH * blow.lasting + speed * row.normal_mass;
  return row.impulse.x > most ? row.impulse * (most / row.impulse.x) : row.impulse;
}

void warm_start(uint at, uint stride, bool restitutes, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  Blow blow = blow_at(at, stride);
  row.impulse = without_blow(row, blow, restitutes);
  rows[at + 3u * stride].xyz = row.impulse;
  rows[at + 4u * stride].z = row.impulse.x;
  apply(row, row.impulse.x * row.normal + row.impulse.y * row.tangent + row.impulse.z * cross(row.normal, row.tangent),
        a, b);
}

// Takes a turn of one body against the other about an axis, by a moment of at most `most`.
void resist(vec3 axis, float speed, float most, inout Side a, inout Side b) {
  vec3 turn_a = tensor_times(a, axis), turn_b = tensor_times(b, axis);
  float k = dot(axis, turn_a) + dot(axis, turn_b);
  float moment = k > 0.0 ? clamp(speed / k, -most, most) : 0.0;
  a.w -= moment * turn_a;
  b.w += moment * turn_b;
}

// Sequential impulse, accumulated and clamped. With `push`, overlap is pushed out softly; without, the velocity that
// pushing left is taken back (relaxation).
void solve_normal(uint at, uint stride, float h, bool push, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  float bias = 0.0, mass_scale = 1.0, impulse_scale = 0.0;
  if (row.gap > 0.0) {
    bias = row.gap / h;  // speculative: may close the distance, no more
  } else if (push) {
    float d = world.gravity.w;
    impulse_scale = spring.impulse_scale;
    mass_scale = spring.mass_scale;
    bias = max(spring.bias_rate * min(0.0, row.gap + softness.z * d), -settings.push_speed / softness.w * d);
  }
  float vn = dot(relative_velocity(row, a, b), row.normal);
  float mass = mass_scale * row.normal_mass;
  float total = max(row.impulse.x - mass * (vn + bias) - impulse_scale * row.impulse.x, 0.0);
  float change = total - row.impulse.x;
  restless = restless || abs(change) > settings.settled * world.gravity.w * row.normal_mass;
  apply(row, change * row.normal, a, b);
  rows[at + 3u * stride].x = total;
  if (total > 0.0) rows[at + 4u * stride].w = 1.0;
}

// Coulomb's cone: both directions at once. Half of all contacts only wait for their gap to close.
void solve_friction(uint at, uint stride, float friction, inout Side a, inout Side b) {
  if (rows[at + 3u * stride].xyz == vec3(0.0)) return;
  Row row = row_at(at, stride);
  vec3 t2 = cross(row.normal, row.tangent), v = relative_velocity(row, a, b);
  vec2 f = row.impulse.yz - row.tangent_mass * vec2(dot(v, row.tangent), dot(v, t2));
  float most = friction * row.impulse.x, size = length(f);
  if (size > most) f *= most / size;
  vec2 change = f - row.impulse.yz;
  apply(row, change.x * row.tangent + change.y * t2, a, b);
  rows[at + 3u * stride].yz = f;
}

// Whether a contact was struck fast enough to bounce: pressed, or closed by a blow that its neighbours took.
bool struck(Row row, Blow blow) {
  if (blow.approach > -settings.restitution_speed) return false;
  return blow.pressed == 1.0 || row.gap < -blow.approach * sub_step();
}

void bounce(uint at, uint stride, float restitution, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  Blow blow = blow_at(at, stride);
  if (!struck(row, blow)) return;
  float vn = dot(relative_velocity(row, a, b), row.normal);
  float total = max(row.impulse.x - row.normal_mass * (vn + restitution * blow.approach), 0.0);
  apply(row, (total - row.impulse.x) * row.normal, a, b);
  rows[at + 3u * stride].x = total;
}
