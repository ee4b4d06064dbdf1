/// A contact as the solver works on it: one row of the Jacobian for each of its three directions, with all that an
/// impulse needs laid out in whole registers.
#pragma once

#include "solver/sphere/math.hpp"

#include <cstdint>

namespace bin_scenes::sphere {

using Vec4f = Eigen::Vector4f;  ///< a vector of three and an unused lane that stays 0

inline Vec4f padded(const Vec3f& v) {
  return {v.x(), v.y(), v.z(), 0.0f};
}

/// How a body moves while contacts are solved.
struct Motion {
  Vec4f v = Vec4f::Zero(), w = Vec4f::Zero();           ///< m/s and rad/s, world frame
  Vec4f moved = Vec4f::Zero(), turned = Vec4f::Zero();  ///< since contacts were found (m, rotation vector)
  float inverse_mass = 0;                               ///< 0: nothing moves it in this step
  bool free = false;                                    ///< moves, and nothing is near it
};

/// J v and M^-1 J^T of one direction. Arms and direction hold for a whole time step.
struct Row {
  Vec4f direction;           ///< of the impulse on b; a gets the opposite
  Vec4f moment_a, moment_b;  ///< arm x direction
  Vec4f turn_a, turn_b;      ///< spin that a unit impulse gives
  float effective_mass, impulse;

  /// Speed of b's point away from a's (m/s).
  float speed(const Motion& a, const Motion& b) const { return along(a.v, a.w, b.v, b.w); }
  /// Way that b's point went away from a's since contacts were found (m), to first order in the turn.
  float way(const Motion& a, const Motion& b) const { return along(a.moved, a.turned, b.moved, b.turned); }

  void push(float amount, Motion& a, Motion& b) const {
    const Vec4f linear = amount * direction;
    a.v -= a.inverse_mass * linear;
    a.w -= amount * turn_a;
    b.v += b.inverse_mass * linear;
    b.w += amount * turn_b;
  }

 private:
  float along(const Vec4f& va, const Vec4f& wa, const Vec4f& vb, const Vec4f& wb) const {
    return (direction.cwiseProduct(vb - va) + moment_b.cwiseProduct(wb) - moment_a.cwiseProduct(wa)).sum();
  }
};

/// The rows of one contact.
struct ContactRows {
  Row normal, t1, t2;
  float separation = 0;                       ///< when contacts were found (m)
  float approach = 0, prepared_approach = 0;  ///< speed before the step's impulses, m/s; negative = closing
  float max_impulse = 0, gap = 0;             ///< largest normal impulse; separation at the last look
};

/// The rows of one manifold.
struct Block {
  std::uint32_t manifold, a, b;  ///< b = number of bodies: the ground
  std::uint32_t first, last;     ///< rows
  float friction, restitution;
};

}  // namespace bin_scenes::sphere
