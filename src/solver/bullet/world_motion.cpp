/// Bodies that follow a path, and what all feel of a bin that moves.
#include "convert.hpp"
#include "world.hpp"

namespace bin_scenes::bullet {

void World::drive(Body& body, const BodyState& state) {
  body.rigid->setLinearVelocity(to_bt(Vec3(state.velocity.linear * scale_)));
  body.rigid->setAngularVelocity(to_bt(state.velocity.angular));
  body.last = state;
}

void World::set_frame(const Frame& frame) {
  frame_ = frame;
  for (const auto& body : bodies_) {
    if (!body->rigid || body->def->fixed) continue;
    if (body->frozen) thaw(*body);
    body->rigid->activate(true);
  }
  world_.setGravity(to_bt(Vec3(frame.gravity * scale_)));  // reaches those that are awake
}

/// What bodies feel of a bin that turns, over a step of `dt`, as it is in its centre.
void World::turn_with_bin(double dt) {
  const btVector3 gravity = world_.getGravity();
  for (const auto& body : bodies_) {
    if (!body->rigid || body->def->fixed) continue;
    const Vec3 x = from_bt(body->rigid->getWorldTransform().getOrigin()), v = from_bt(body->rigid->getLinearVelocity());
    const Vec3 mid_step_v = v + 0.5 * dt * (from_bt(gravity) + frame_.acceleration(x, v));
    body->rigid->setGravity(gravity + to_bt(frame_.acceleration(x + 0.5 * dt * v, mid_step_v)));
  }
}

/// The same of their spin. Half of it comes before a step and half behind it, so that they turn by the mean.
void World::spin_with_bin(double dt) {
  for (const auto& body : bodies_) {
    if (!body->rigid || body->def->fixed) continue;
    const Mat3 axes = from_bt(body->rigid->getWorldTransform()).orientation.toRotationMatrix();
    const Mat3 inertia = axes * body->motion.inertia.asDiagonal() * axes.transpose();
    const Mat3 inverse = axes * body->motion.inertia.cwiseInverse().asDiagonal() * axes.transpose();
    const Vec3 w = from_bt(body->rigid->getAngularVelocity());
    const Vec3 center = w + 0.5 * dt * frame_.angular_acceleration(w, inertia, inverse);
    body->rigid->setAngularVelocity(to_bt(Vec3(w + dt * frame_.angular_acceleration(center, inertia, inverse))));
  }
}

}  // namespace bin_scenes::bullet
