// The work of one sweep of the solve on one contact: normal impulse and friction. Twin: contact_rows.hpp, friction.hpp,
// restitution.hpp. Needs sphere/contact_row.h, sphere/solve_step.h, `unconverged`, and the binding Settings.
#include "shared/sphere/patch.h"

void apply(Row row, vec3 impulse, inout Sides s) {
  s.between += inverse_masses(s) * impulse;
  s.a.w -= tensor_times(s.a, cross(row.ra, impulse));
  s.b.w += tensor_times(s.b, cross(row.rb, impulse));
}

// Returns whether a contact is fast enough to bounce. approach: m/s, negative if the bodies approach each other.
bool strikes(float approach) { return approach <= -settings.restitution_speed; }

// Returns the share of a contact's impulse with which the next sub-step starts, without the part due to an impact.
float lasting_share_at(uint at, uint stride, float normal_mass) {
  float speed = impact_speed(plan.sub_step, length(world.gravity.xyz), settings.restitution_speed);
  return lasting_share(impulses[at].x, lasting_at(at, stride), normal_mass, speed);
}

// Applies the impulses of the last sub-step. bounces: the contact keeps all of the impulse until it has bounced.
void warm_start(uint at, uint stride, bool bounces, inout Sides s) {
  Row row = row_at(at, stride);
  float share = bounces ? 1.0 : lasting_share_at(at, stride, row.normal_mass), along = share * impulses[at].x;
  vec3 friction = share * friction_at(at, stride);
  impulses[at].x = along;
  keep_friction(at, stride, friction);
  keep_lasting(at, stride, along, pressed_at(at, stride));
  apply(row, along * row.normal + friction, s);
}

// Reduces the rotation of a relative to b about an axis, whose rate is `speed` (rad/s), by at most `most` (N m s).
void resist(vec3 axis, float speed, float most, inout Sides s) {
  vec3 turn_a = tensor_times(s.a, axis), turn_b = tensor_times(s.b, axis);
  float moment = moment_against(speed, most, axis, turn_a, turn_b);
  s.a.w -= moment * turn_a;
  s.b.w += moment * turn_b;
}

// Lever arm x normal (m), for both bodies. They give the speed along the normal, and the effect of a normal impulse.
struct Moments {
  vec3 a, b;
};

Moments moments_of(Row row) { return Moments(cross(row.ra, row.normal), cross(row.rb, row.normal)); }

float speed_along(vec3 normal, Moments m, Sides s) {
  return dot(normal, s.between) + dot(m.b, s.b.w) - dot(m.a, s.a.w);
}

void apply_along(float impulse, vec3 normal, Moments m, inout Sides s) {
  s.between += inverse_masses(s) * impulse * normal;
  s.a.w -= impulse * tensor_times(s.a, m.a);
  s.b.w += impulse * tensor_times(s.b, m.b);
}

// Solves the normal impulse of a contact; change: its change (N s); hit: a contact of the manifold closes fast, so that
// it is recorded that this one has pressed. Returns whether there may be friction, which is 0 without normal impulse.
bool solve_normal(uint at, uint stride, Row row, Give give, bool hit, out float change, inout Sides s) {
  vec2 before = impulses[at];  // x: normal impulse, y: gap
  Moments moments = moments_of(row);
  float total = normal_impulse(before.x, speed_along(row.normal, moments, s), before.y, row.normal_mass, give);
  change = total - before.x;
  unconverged = unconverged || is_unconverged(change, row.normal_mass, tolerance);
  apply_along(change, row.normal, moments, s);
  impulses[at].x = total;
  if (hit && total > 0.0) keep_lasting(at, stride, lasting_at(at, stride), true);
  return max(before.x, total) > 0.0;
}

void solve_friction(uint at, uint stride, Row row, float friction, inout Sides s) {
  vec3 before = friction_at(at, stride), v = relative_velocity(row, s);
  vec3 f = before - row.tangent_mass * (v - dot(v, row.normal) * row.normal);
  float most = friction * impulses[at].x, size = length(f);
  f *= select(size > most, most / size, 1.0);
  apply(row, f - before, s);
  keep_friction(at, stride, f);
}

bool is_hit(uint at, uint stride, float approach) {
  return was_hit(approach, pressed_at(at, stride), impulses[at].y, plan.sub_step, settings.restitution_speed);
}

void bounce(uint at, uint stride, float restitution, float approach, inout Sides s) {
  if (!is_hit(at, stride, approach)) return;
  Row row = row_at(at, stride);
  Moments moments = moments_of(row);
  float before = impulses[at].x, speed = speed_along(row.normal, moments, s);
  float total = bounced_impulse(before, speed, row.normal_mass, restitution, approach);
  apply_along(total - before, row.normal, moments, s);
  impulses[at].x = total;
}
