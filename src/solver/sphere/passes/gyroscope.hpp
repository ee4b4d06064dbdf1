/// The gyroscopic torque of spinning bodies whose moments of inertia are not all equal. It is integrated by the
/// implicit midpoint rule, because an explicit step adds energy to a body that spins fast. GPU form:
/// shaders/sphere/solve_body.h.
#pragma once

#include "solver/sphere/world.hpp"

namespace bin_scenes::sphere {

#include "shared/sphere/gyroscope.h"

/// Returns the change of the angular velocity `w` over h seconds in the body frame, by the implicit midpoint rule for
/// Euler's equations. It conserves the energy and the length of the angular momentum, both quadratic (Hairer, Lubich,
/// Wanner 2006, IV.2).
/// @param rotation  matrix of b.q
inline Vec3f gyroscopic_change(const Body& b, const Mat3f& rotation, const Vec3f& w, float h) {
  const Vec3f before = rotation.transpose() * w;
  Vec3f change = Vec3f::Zero();
  for (int k = 0; k < 6; ++k) {
    const Vec3f mid = before + 0.5f * change;
    change = -h * (b.inverse_inertia * mid.cross(b.inertia * mid));
  }
  return change;
}

/// Turns a body that nothing touches for h seconds. Half of the change of its spin comes before the rotation, so that
/// it turns with the mean spin: this conserves the direction of the angular momentum as well (Austin, Krishnaprasad and
/// Wang 1993, "Almost Poisson integration of rigid body systems"). Only changes are turned back to world axes: turning
/// all of the spin would let |L| creep by a thousandth in ten thousand sub-steps of single precision.
inline void turn_freely(Body& b, Vec3f& w, float h) {
  const int steps = steps_of_free_turn(w.norm() * h);
  h /= static_cast<float>(steps);
  for (int k = 0; k < steps; ++k) {
    const Mat3f rotation = b.q.toRotationMatrix();
    const Vec3f half = 0.5f * gyroscopic_change(b, rotation, w, h * time_of_free_turn(w.norm() * h));
    w += rotation * half;
    b.q = integrated(b.q, w, h);
    w += b.q.toRotationMatrix() * half;
  }
}

}  // namespace bin_scenes::sphere
