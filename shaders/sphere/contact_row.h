// One contact in the solve: where its row lies (shared/sphere.h), and what a sweep does with it. The row of contact k of
// a manifold begins at rows[at]; its parts lie `stride` behind each other. Twin: contact_rows.hpp. Needs the bindings
// Settings, Bodies, Rows, sphere/solve_step.h, `unconverged`, struct Side, shared/rotation.h.
#include "shared/sphere/patch.h"

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
struct Impact {
  float separation;  // when contacts were found (m)
  float approach;    // speed at which the two meet if they do in this step (m/s), negative: closing
  float lasting;     // normal impulse that the sub-step began with (N s)
  float pressed;     // 1: it has pressed in this step
};

Impact impact_at(uint at, uint stride) {
  vec4 v = rows[at + 4u * stride];
  return Impact(v.x, v.y, v.z, v.w);
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
  return effective_mass(a.inverse_mass + b.inverse_mass, ta, tensor_times(a, ta), tb, tensor_times(b, tb));
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

// Of the contact, when the step begins.
float approach_of(Row row, Side a, Side b) {
  float falls = float(b.inverse_mass > 0.0) - float(a.inverse_mass > 0.0);
  return speed_at_impact(dot(relative_velocity(row, a, b), row.normal), row.gap,
                         falls * dot(row.normal, world.gravity.xyz));
}

// Takes from an impulse what was an impact. What bounces keeps the impulse of its impact, which the bounce may have to
// take back, until it has bounced.
vec3 without_impact(Row row, Impact impact, bool restitutes) {
  if (restitutes && impact.approach <= -settings.restitution_speed) return row.impulse;
  float speed = impact_speed(plan.sub_step, length(world.gravity.xyz), settings.restitution_speed);
  return lasting_share(row.impulse.x, impact.lasting, row.normal_mass, speed) * row.impulse;
}

void warm_start(uint at, uint stride, bool restitutes, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  Impact impact = impact_at(at, stride);
  row.impulse = without_impact(row, impact, restitutes);
  rows[at + 3u * stride].xyz = row.impulse;
  rows[at + 4u * stride].z = row.impulse.x;
  apply(row, row.impulse.x * row.normal + row.impulse.y * row.tangent + row.impulse.z * cross(row.normal, row.tangent),
        a, b);
}

// Takes a turn of one body against the other about an axis, by a moment of at most `most`.
void resist(vec3 axis, float speed, float most, inout Side a, inout Side b) {
  vec3 turn_a = tensor_times(a, axis), turn_b = tensor_times(b, axis);
  float moment = moment_against(speed, most, axis, turn_a, turn_b);
  a.w -= moment * turn_a;
  b.w += moment * turn_b;
}

void solve_normal(uint at, uint stride, Give give, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  float speed = dot(relative_velocity(row, a, b), row.normal);
  float total = normal_impulse(row.impulse.x, speed, row.gap, row.normal_mass, give), change = total - row.impulse.x;
  unconverged = unconverged || is_unconverged(change, row.normal_mass, settings.tolerance * world.gravity.w);
  apply(row, change * row.normal, a, b);
  rows[at + 3u * stride].x = total;
  if (total > 0.0) rows[at + 4u * stride].w = 1.0;
}

// Half of all contacts only wait for their gap to close.
void solve_friction(uint at, uint stride, float friction, inout Side a, inout Side b) {
  if (rows[at + 3u * stride].xyz == vec3(0.0)) return;
  Row row = row_at(at, stride);
  vec3 t2 = cross(row.normal, row.tangent), v = relative_velocity(row, a, b);
  vec2 f = row.impulse.yz - row.tangent_mass * vec2(dot(v, row.tangent), dot(v, t2));
  put_into_cone(friction * row.impulse.x, f.x, f.y);
  vec2 change = f - row.impulse.yz;
  apply(row, change.x * row.tangent + change.y * t2, a, b);
  rows[at + 3u * stride].yz = f;
}

bool hit(Row row, Impact impact) {
  return was_hit(impact.approach, impact.pressed == 1.0, row.gap, plan.sub_step, settings.restitution_speed);
}

void bounce(uint at, uint stride, float restitution, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  Impact impact = impact_at(at, stride);
  if (!hit(row, impact)) return;
  float speed = dot(relative_velocity(row, a, b), row.normal);
  float total = bounced_impulse(row.impulse.x, speed, row.normal_mass, restitution, impact.approach);
  apply(row, (total - row.impulse.x) * row.normal, a, b);
  rows[at + 3u * stride].x = total;
}
