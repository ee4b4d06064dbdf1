#include "dynamics_world.hpp"

#include "convert.hpp"

#include <initializer_list>

namespace bin_scenes::bullet {

namespace {

btQuaternion rotation(const btVector3& turn) {
  const btScalar angle = turn.length();
  if (angle < 1e-12) return btQuaternion(0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z(), 1).normalized();
  return btQuaternion(turn / angle, angle);
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Vec3 torque_free_step(const Vec3& inertia, const Vec3& angular, double dt) {
  const Mat3 I = inertia.asDiagonal();
  Vec3 next = angular;
  for (int newton = 0; newton < 8; ++newton) {
    const Vec3 w = 0.5 * (angular + next), momentum = inertia.cwiseProduct(w);
    const Vec3 error = inertia.cwiseProduct(next - angular) + dt * w.cross(momentum);
    const Mat3 slope = I + 0.5 * dt * (cross_matrix(w) * I - cross_matrix(momentum));
    const Vec3 change = slope.inverse() * error;
    next -= change;
    if (change.squaredNorm() <= 1e-30 * angular.squaredNorm()) break;
  }
  return next;
}

void DynamicsWorld::predictUnconstraintMotion(btScalar dt) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (body.isStaticOrKinematicObject() || !body.isActive()) continue;
    Motion& motion = *static_cast<Motion*>(body.getUserPointer());
    motion.linear = body.getLinearVelocity();
    motion.touch = Motion::Touch::nothing;
    const btMatrix3x3& axes = body.getWorldTransform().getBasis();
    const Vec3 start = from_bt(axes.transpose() * body.getAngularVelocity());
    const Vec3 end = torque_free_step(motion.inertia, start, dt);
    motion.middle = axes * to_bt(Vec3(0.5 * (start + end)));
    motion.free = btMatrix3x3(rotation(motion.middle * dt)) * axes * to_bt(end);
    body.setAngularVelocity(motion.free);
  }
}

void DynamicsWorld::find_touches() {
  constexpr btScalar parallel = 1e-4;
  for (int m = 0; m < getDispatcher()->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *getDispatcher()->getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      if (manifold.getContactPoint(p).m_appliedImpulse <= 0) continue;
      const btVector3& normal = manifold.getContactPoint(p).m_normalWorldOnB;
      for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()}) {
        Motion* motion = static_cast<Motion*>(object->getUserPointer());
        if (!motion) continue;
        if (motion->touch == Motion::Touch::nothing) {
          motion->touch = Motion::Touch::plane;
          motion->normal = normal;
        } else if (motion->normal.cross(normal).length2() > parallel) {
          motion->touch = Motion::Touch::more;
        }
      }
    }
  }
}

void DynamicsWorld::integrateTransforms(btScalar dt) {
  // Smooth forces act through the step, so the mean of the velocities before and after carries the body (trapezoidal
  // rule): gravity in free flight, friction and gravity along the plane a body slides or rolls on. Everything else
  // follows the velocity after the step: what a contact forbids must hold at its end, or heaps rock without end, and a
  // change beyond what gravity and friction can do in one step is an impact at its start.
  find_touches();
  const btScalar smooth = 3 * getGravity().length() * dt;
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (body.isStaticOrKinematicObject() || !body.isActive()) continue;
    const Motion& motion = *static_cast<const Motion*>(body.getUserPointer());
    btVector3 gained(0, 0, 0);
    if (motion.touch != Motion::Touch::more) gained = body.getLinearVelocity() - motion.linear;
    if (motion.touch == Motion::Touch::plane) {
      gained -= motion.normal * motion.normal.dot(gained);
      if (gained.length() > smooth) gained.setZero();
    }
    const btVector3 turn = motion.middle + body.getAngularVelocity() - motion.free;
    const btTransform& now = body.getWorldTransform();
    btTransform next;
    next.setOrigin(now.getOrigin() + (body.getLinearVelocity() - gained * btScalar(0.5)) * dt);
    next.setRotation((rotation(turn * dt) * now.getRotation()).normalized());
    body.proceedToTransform(next);
  }
}

}  // namespace bin_scenes::bullet
