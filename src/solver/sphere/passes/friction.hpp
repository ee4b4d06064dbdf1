/// The friction of eight contacts at once: against sliding, and of a contact patch against rotation. The arithmetic
/// itself is shared with the GPU form (shaders/shared/sphere).
#pragma once

#include "solver/sphere/passes/contact_rows.hpp"

namespace bin_scenes::sphere {

/// Applies the torques by which contact patches resist rotation to the velocities `u`. radius: of a patch (m).
inline void resist_turn(const Bundle& bundle, const std::vector<ContactRows>& rows, Lanes radius, Lanes friction,
                        Velocities& u) {
  Patch patch = open_patch(LaneVec{});
  for (std::uint32_t i = bundle.first; i < bundle.last; ++i)
    gather(patch, rows[i].normal_impulse, rows[i].ra, rows[i].normal);
  close_patch(patch, u.wa - u.wb);
  for (std::uint32_t i = bundle.first; i < bundle.last; ++i) spread(patch, rows[i].normal_impulse, rows[i].ra);
  const auto resist = [&](const LaneVec& axis, Lanes speed, Lanes most) {
    const LaneVec turn_a = bundle.inverse_inertia_a * axis, turn_b = bundle.inverse_inertia_b * axis;
    const Lanes moment = moment_against(speed, most, axis, turn_a, turn_b);
    u.wa = u.wa - moment * turn_a;
    u.wb = u.wb + moment * turn_b;
  };
  resist(patch.normal, patch.spin, most_against_spin(patch, radius, friction));
  resist(patch.tip_axis, patch.tipping, most_against_tipping(patch, radius, bundle.tipping_arm));
}

/// Returns which contacts press, or have friction impulses left. Half of all contacts only wait for their gap to close.
inline LaneMask has_friction(const ContactRows& c) {
  return (c.normal_impulse > 0.0f) | (c.t1_impulse != 0.0f) | (c.t2_impulse != 0.0f);
}

inline void solve_friction(ContactRows& c, Lanes friction, const Bundle& bundle, Velocities& u) {
  const LaneVec second = cross(c.normal, c.tangent), speed = u.at(c);
  Lanes f1 = c.t1_impulse - c.tangent_mass * dot(c.tangent, speed);
  Lanes f2 = c.t2_impulse - c.tangent_mass * dot(second, speed);
  put_into_cone(friction * c.normal_impulse, f1, f2);
  u.push((f1 - c.t1_impulse) * c.tangent + (f2 - c.t2_impulse) * second, c, bundle);
  c.t1_impulse = f1;
  c.t2_impulse = f2;
}

}  // namespace bin_scenes::sphere
