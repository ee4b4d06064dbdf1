// The work of one sweep of the solve on one contact: normal impulse and friction. Twin: contact_rows.hpp, friction.hpp,
// restitution.hpp. Needs sphere/contact_row.h, sphere/solve_step.h, `unconverged`, and the binding Settings.
#include "shared/sphere/patch.h"

void apply(Row row, vec3 impulse, inout Side a, inout Side b) {
  a.v -= a.inverse_mass * impulse;
  a.w -= tensor_times(a, cross(row.ra, impulse));
  b.v += b.inverse_mass * impulse;
  b.w += tensor_times(b, cross(row.rb, impulse));
}

// A contact that is fast enough to bounce.
bool strikes(float approach) { return approach <= -settings.restitution_speed; }

// Share of a contact's impulse that lasts when what was an impact is removed.
float lasting_share_at(uint at, uint stride, float normal_mass) {
  float speed = impact_speed(plan.sub_step, length(world.gravity.xyz), settings.restitution_speed);
  return lasting_share(impulses[at].x, lasting_at(at, stride), normal_mass, speed);
}

// bounces: it keeps the impulse of its impact, which the bounce may have to take back, until it has bounced.
void warm_start(uint at, uint stride, bool bounces, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  float share = bounces ? 1.0 : lasting_share_at(at, stride, row.normal_mass), along = share * impulses[at].x;
  vec3 friction = share * friction_at(at, stride);
  impulses[at].x = along;
  keep_friction(at, stride, friction);
  keep_lasting(at, stride, along, pressed_at(at, stride));
  apply(row, along * row.normal + friction, a, b);
}

// Takes a turn of one body against the other about an axis, by a moment of at most `most`.
void resist(vec3 axis, float speed, float most, inout Side a, inout Side b) {
  vec3 turn_a = tensor_times(a, axis), turn_b = tensor_times(b, axis);
  float moment = moment_against(speed, most, axis, turn_a, turn_b);
  a.w -= moment * turn_a;
  b.w += moment * turn_b;
}

// An impulse along the normal meets the speed there and the spins that it gives by the same moments.
struct Moments {
  vec3 a, b;
};

Moments moments_of(Row row) { return Moments(cross(row.ra, row.normal), cross(row.rb, row.normal)); }

float speed_along(vec3 normal, Moments m, Side a, Side b) {
  return dot(normal, b.v - a.v) + dot(m.b, b.w) - dot(m.a, a.w);
}

void apply_along(float impulse, vec3 normal, Moments m, inout Side a, inout Side b) {
  a.v -= a.inverse_mass * impulse * normal;
  a.w -= impulse * tensor_times(a, m.a);
  b.v += b.inverse_mass * impulse * normal;
  b.w += impulse * tensor_times(b, m.b);
}

// hit: something of its manifold is, which alone needs to know whether a contact has pressed. Returns whether there may be
// friction: where the contact has not pressed before either, it is 0.
bool solve_normal(uint at, uint stride, Give give, bool hit, out float change, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  vec2 before = impulses[at];  // gap behind it
  Moments moments = moments_of(row);
  float total = normal_impulse(before.x, speed_along(row.normal, moments, a, b), before.y, row.normal_mass, give);
  change = total - before.x;
  unconverged = unconverged || is_unconverged(change, row.normal_mass, tolerance);
  apply_along(change, row.normal, moments, a, b);
  impulses[at].x = total;
  if (hit && total > 0.0) keep_lasting(at, stride, lasting_at(at, stride), true);
  return max(before.x, total) > 0.0;
}

void solve_friction(uint at, uint stride, float friction, inout Side a, inout Side b) {
  Row row = row_at(at, stride);
  vec3 before = friction_at(at, stride), v = relative_velocity(row, a, b);
  vec3 f = before - row.tangent_mass * (v - dot(v, row.normal) * row.normal);
  float most = friction * impulses[at].x, size = length(f);
  f *= select(size > most, most / size, 1.0);
  apply(row, f - before, a, b);
  keep_friction(at, stride, f);
}

bool is_hit(uint at, uint stride, float approach) {
  return was_hit(approach, pressed_at(at, stride), impulses[at].y, plan.sub_step, settings.restitution_speed);
}

void bounce(uint at, uint stride, float restitution, float approach, inout Side a, inout Side b) {
  if (!is_hit(at, stride, approach)) return;
  Row row = row_at(at, stride);
  Moments moments = moments_of(row);
  float before = impulses[at].x, speed = speed_along(row.normal, moments, a, b);
  float total = bounced_impulse(before, speed, row.normal_mass, restitution, approach);
  apply_along(total - before, row.normal, moments, a, b);
  impulses[at].x = total;
}
