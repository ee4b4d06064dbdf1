/// The forces on bodies in a rotating bin: Coriolis and centrifugal forces, and the force due to changes of the angular
/// velocity. The simulation uses the frame of the bin, in which the bin is at rest; without a rotation these forces are
/// zero.
#pragma once

#include "solver/sphere/passes/blocks.hpp"
#include "solver/sphere/passes/contact_rows.hpp"

namespace bin_scenes::sphere {

/// Changes the velocities of bodies by these forces over a sub-step of `h` seconds, computed in double precision.
inline void turn_with_bin(const World& world, const Slice& bodies, float h, std::vector<Motion>& motions) {
  const auto vector = [](Quad q) { return Vec3(q[0], q[1], q[2]); };
  const auto add = [h](Quad& to, const Vec3& change) {
    to += Quad{static_cast<float>(h * change.x()), static_cast<float>(h * change.y()),
               static_cast<float>(h * change.z()), 0.0f};
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Motion& motion = motions[i];
    if (motion.inverse_mass() == 0) continue;  // on a path
    const Body& b = world.bodies[bodies[i]];
    const Mat3 r = b.q.cast<double>().normalized().toRotationMatrix();
    const Mat3 inertia = r * b.inertia.cast<double>() * r.transpose();
    const Mat3 inverse = r * b.inverse_inertia.cast<double>() * r.transpose();
    const Vec3 x = b.x.cast<double>() + vector(motion.moved), v = vector(motion.v), w = vector(motion.w);
    add(motion.v, world.frame.acceleration(x, v));
    add(motion.w, world.frame.angular_acceleration(w, inertia, inverse));
  }
}

}  // namespace bin_scenes::sphere
