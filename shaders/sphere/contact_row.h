// Reads and writes the row and the impulses of one contact in the solve (layout: shared/sphere.h). The first part is at
// rows[at] and impulses[at]; the next parts are `stride` elements apart. Needs the bindings Rows and Impulses, and
// shared/rotation.h. Twin: contact_rows.hpp.
#include "shared/sphere/contact.h"

// The values of a body that the solution of one manifold needs. All are 0 if the body cannot move.
struct Side {
  vec3 w;              // angular velocity (rad/s)
  float inverse_mass;  // 1/kg
  vec3 tensor, tensor_mixed;  // inverse inertia in world axes (1/(kg m2)): xx yy zz, and xy xz yz
};

// Both bodies of a manifold. Contacts need only the velocity of b relative to a, so that an impulse changes one
// vector instead of two.
struct Sides {
  Side a, b;
  vec3 between;  // velocity of b's centre of mass relative to that of a (m/s)
};

float inverse_masses(Sides s) { return s.a.inverse_mass + s.b.inverse_mass; }

vec3 tensor_times(Side s, vec3 v) { return symmetric_times(s.tensor, s.tensor_mixed, v); }

// The data of a contact that sweeps read but do not change.
struct Row {
  vec3 normal, ra, rb;              // unit normal from a to b; lever arms from the centres of mass (m); world axes
  float normal_mass, tangent_mass;  // effective masses (kg)
};

Row row_at(uint at, uint stride) {
  vec4 n = rows[at], a = rows[at + stride], b = rows[at + 2u * stride];
  return Row(n.xyz, a.xyz, b.xyz, n.w, a.w);
}
float found_gap_at(uint at, uint stride) { return rows[at + 2u * stride].w; }

// Returns the friction impulse (N s, world axes); as a vector, it needs no tangents, whose storage would cost more.
vec3 friction_at(uint at, uint stride) { return vec3(impulses[at + stride], impulses[at + 2u * stride].x); }
void keep_friction(uint at, uint stride, vec3 friction) {
  impulses[at + stride] = friction.xy;
  impulses[at + 2u * stride].x = friction.z;
}

// Read and write the normal impulse at the start of the sub-step (N s), and whether the contact has pressed in a step.
float lasting_at(uint at, uint stride) { return abs(impulses[at + 2u * stride].y); }
bool pressed_at(uint at, uint stride) { return floatBitsToInt(impulses[at + 2u * stride].y) < 0; }
void keep_lasting(uint at, uint stride, float lasting, bool pressed) {
  uint size = floatBitsToUint(lasting) & 0x7fffffffu;  // max(-0.0, 0.0) is either on some device
  impulses[at + 2u * stride].y = uintBitsToFloat(size | (pressed ? 0x80000000u : 0u));
}

// Returns a unit vector perpendicular to the unit vector n. The second tangent of a contact is normal x tangent.
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

// Computes the effective masses of a row from its lever arms, its normal and the inertia of the bodies, and stores it.
void keep_row(uint at, uint stride, Row row, float found_gap, Sides s) {
  vec3 t1 = tangent_of(row.normal), t2 = cross(row.normal, t1);
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  float tangent_mass = min(mass_along(t1, row, s), mass_along(t2, row, s));
  rows[at] = vec4(row.normal, mass_along(row.normal, row, s));
  rows[at + stride] = vec4(row.ra, tangent_mass);
  rows[at + 2u * stride] = vec4(row.rb, found_gap);
}
