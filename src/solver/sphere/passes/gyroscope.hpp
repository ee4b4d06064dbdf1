/// The gyroscopic torque of spinning bodies whose moments of inertia are not all equal. It is integrated by the
/// implicit midpoint rule, because an explicit step adds energy to a body that spins fast.
#pragma once

#include "solver/sphere/world.hpp"

namespace bin_scenes::sphere {

/// Returns the change of the angular velocity `w` over h seconds, by the implicit midpoint rule for Euler's equations
/// in the body frame.
inline Vec3f gyroscopic_change(const Body& b, const Vec3f& w, float h) {
  // Only the change is turned back to world axes: turning all of the spin would let |L| creep by a thousandth in ten
  // thousand sub-steps of single precision.
  const Mat3f r = b.q.toRotationMatrix();
  const Vec3f before = r.transpose() * w;
  Vec3f change = Vec3f::Zero();
  for (int k = 0; k < 6; ++k) {
    const Vec3f mid = before + 0.5f * change;
    change = -h * (b.inverse_inertia * mid.cross(b.inertia * mid));
  }
  return r * change;
}

}  // namespace bin_scenes::sphere
