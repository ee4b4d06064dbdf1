/// The gap of a contact at the present poses, and whether two bodies are about to hit each other. GLSL: contact_gap.h.
#pragma once

#include "solver/sphere/world.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

/// Returns the normal of a contact at the present poses (unit vector from a to b, world axes).
inline Vec3f normal_of(const Contact& c, const Body& a, const Body* b) {
  const bool field_of_a = c.feature & SPHERE_SIDE_B;
  return field_of_a ? Vec3f(a.rotation * c.local_normal) : b ? Vec3f(b->rotation * c.local_normal) : c.local_normal;
}

/// Return the points of a contact on the surfaces of a and b (m, bin frame) at the present poses.
inline Vec3f on_a(const Contact& c, const Body& a) {
  return a.x + a.rotation * c.anchor_a;
}
inline Vec3f on_b(const Contact& c, const Body* b) {
  return b ? Vec3f(b->x + b->rotation * c.anchor_b) : c.anchor_b;
}

/// Returns the gap (m) of a contact along its normal at the present poses; negative if the bodies overlap.
inline float separation(const Contact& c, const Body& a, const Body* b) {
  return (on_b(c, b) - on_a(c, a)).dot(normal_of(c, a, b));
}

/// Returns whether a contact of the pair that does not press yet closes within `seconds`, or all but `left` (m) of its
/// gap, and the bodies approach there by more than `least` (m).
inline bool strikes(const World& world, const Manifold& m, float seconds, float least, float left = 0) {
  const Body& a = world.bodies[m.a];
  const Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
  const auto velocity = [](const Body& body, const Vec3f& anchor) {
    return body.moves() ? Vec3f(body.v + body.w.cross(body.rotation * anchor)) : Vec3f(Vec3f::Zero());
  };
  return std::any_of(m.contacts.begin(), m.contacts.end(), [&](const Contact& c) {
    if (c.normal_force > 0) return false;
    const Vec3f nearing = velocity(a, c.anchor_a) - (b ? velocity(*b, c.anchor_b) : Vec3f(Vec3f::Zero()));
    const float approach = seconds * nearing.dot(normal_of(c, a, b));
    return approach > least && approach > separation(c, a, b) - left;
  });
}

}  // namespace bin_scenes::sphere
