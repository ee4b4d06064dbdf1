// One contact in the solve: where its row and its impulses are stored (shared/sphere.h). Those of contact k of a manifold
// begin at rows[at] and impulses[at]; their parts are `stride` apart. Needs the bindings Rows and Impulses, and
// shared/rotation.h. Twin: contact_rows.hpp.
#include "shared/sphere/contact.h"

// A body as one manifold sees it. All 0: it cannot move.
struct Side {
  vec3 w;
  float inverse_mass;
  vec3 tensor, tensor_mixed;  // inverse inertia, world axes
};

// Both bodies of a manifold. Contacts need only the velocity of b relative to a, between the centres of mass: each impulse
// changes one vector in place of two.
struct Sides {
  Side a, b;
  vec3 between;  // m/s
};

float inverse_masses(Sides s) { return s.a.inverse_mass + s.b.inverse_mass; }

vec3 tensor_times(Side s, vec3 v) { return symmetric_times(s.tensor, s.tensor_mixed, v); }

// What sweeps only read: levers from the centres of mass (m), effective masses (kg).
struct Row {
  vec3 normal, ra, rb;
  float normal_mass, tangent_mass;
};

Row row_at(uint at, uint stride) {
  vec4 n = rows[at], a = rows[at + stride], b = rows[at + 2u * stride];
  return Row(n.xyz, a.xyz, b.xyz, n.w, a.w);
}
float found_gap_at(uint at, uint stride) { return rows[at + 2u * stride].w; }

// Of friction (N s, world axes). Perpendicular to the normal: two tangents would cost more than a third number.
vec3 friction_at(uint at, uint stride) { return vec3(impulses[at + stride], impulses[at + 2u * stride].x); }
void keep_friction(uint at, uint stride, vec3 friction) {
  impulses[at + stride] = friction.xy;
  impulses[at + 2u * stride].x = friction.z;
}

// Normal impulse that the sub-step began with (N s), and whether the contact has pressed in this step.
float lasting_at(uint at, uint stride) { return abs(impulses[at + 2u * stride].y); }
bool pressed_at(uint at, uint stride) { return floatBitsToInt(impulses[at + 2u * stride].y) < 0; }
void keep_lasting(uint at, uint stride, float lasting, bool pressed) {
  uint size = floatBitsToUint(lasting) & 0x7fffffffu;  // max(-0.0, 0.0) is either on some device
  impulses[at + 2u * stride].y = uintBitsToFloat(size | (pressed ? 0x80000000u : 0u));
}

// The first tangent; the second is normal x tangent.
vec3 tangent_of(vec3 n) {
  bool level = abs(n.x) > 1e-5 * abs(n.z) || abs(n.y) > 1e-5 * abs(n.z);
  vec2 pair = level ? n.xy : n.yz;
  pair *= inversesqrt(dot(pair, pair));
  return level ? vec3(-pair.y, pair.x, 0.0) : vec3(0.0, -pair.y, pair.x);
}

vec3 relative_velocity(Row row, Sides s) { return s.between + cross(s.b.w, row.rb) - cross(s.a.w, row.ra); }

float mass_along(vec3 direction, Row row, Sides s) {
  vec3 ta = cross(row.ra, direction), tb = cross(row.rb, direction);
  return effective_mass(inverse_masses(s), ta, tensor_times(s.a, ta), tb, tensor_times(s.b, tb));
}

// Masses from levers, normal and inertia; keeps what depends on where the bodies are.
void keep_row(uint at, uint stride, Row row, float found_gap, Sides s) {
  vec3 t1 = tangent_of(row.normal), t2 = cross(row.normal, t1);
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  float tangent_mass = min(mass_along(t1, row, s), mass_along(t2, row, s));
  rows[at] = vec4(row.normal, mass_along(row.normal, row, s));
  rows[at + stride] = vec4(row.ra, tangent_mass);
  rows[at + 2u * stride] = vec4(row.rb, found_gap);
}
