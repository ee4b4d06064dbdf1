#include "dynamics_world.hpp"

#include "convert.hpp"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes::bullet {

namespace {

constexpr int most_cuts = 1000;  ///< of a torque-free step; only what is not finite needs more

btQuaternion rotation(const btVector3& turn) {
  const btScalar angle = turn.length();
  if (angle < 1e-12) return btQuaternion(0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z(), 1).normalized();
  return btQuaternion(turn / angle, angle);
}

btTransform moved(const btTransform& from, const btVector3& displacement, const btQuaternion& turn) {
  return btTransform((turn * from.getRotation()).normalized(), from.getOrigin() + displacement);
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Motion* motion_of(const btSolverBody& body) {
  return body.m_originalBody ? static_cast<Motion*>(body.m_originalBody->getUserPointer()) : nullptr;
}

bool is_ball(const btCollisionObject& body) {
  return body.getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE;
}

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
    motion.touches = false;
    const btMatrix3x3& axes = body.getWorldTransform().getBasis();
    Vec3 angular = from_bt(axes.transpose() * body.getAngularVelocity());
    const double turned = angular.norm() * dt / turn_per_step;
    const int cuts = turned < most_cuts ? std::max(1, static_cast<int>(std::ceil(turned))) : most_cuts;
    btQuaternion turn(0, 0, 0, 1);  // in the body frame: each cut turns the axes in which the next one is given
    for (int k = 0; k < cuts; ++k) {
      const Vec3 end = torque_free_step(motion.inertia, angular, dt / cuts);
      turn = (turn * rotation(to_bt(Vec3(0.5 * (angular + end))) * (dt / cuts))).normalized();
      angular = end;
    }
    const btQuaternion start = body.getWorldTransform().getRotation();
    motion.turn = start * turn * start.inverse();
    body.setAngularVelocity(btMatrix3x3(motion.turn) * axes * to_bt(angular));
  }
}

void DynamicsWorld::performDiscreteCollisionDetection() {
  const btScalar dt = getDispatchInfo().m_timeStep;
  const btScalar contact_time = btScalar(0.5) * (dt - dt / btScalar(getSolverInfo().m_numIterations));
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    Motion& motion = *static_cast<Motion*>(body.getUserPointer());
    motion.start = body.getWorldTransform();
    motion.ahead_moved = motion.ahead_turned = btVector3(0, 0, 0);
    if (body.isStaticOrKinematicObject() || !body.isActive() || is_ball(body)) continue;
    motion.ahead_moved = body.getLinearVelocity() * contact_time;
    motion.ahead_turned = body.getAngularVelocity() * contact_time;
    body.setWorldTransform(moved(motion.start, motion.ahead_moved, rotation(motion.ahead_turned)));
    body.updateInertiaTensor();
  }
  btDiscreteDynamicsWorld::performDiscreteCollisionDetection();
}

void DynamicsWorld::integrateTransforms(btScalar dt) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    const Motion& motion = *static_cast<const Motion*>(body.getUserPointer());
    if (body.isKinematicObject()) {  // along its path, as far as this step goes
      body.proceedToTransform(
          moved(motion.start, body.getLinearVelocity() * dt, rotation(body.getAngularVelocity() * dt)));
      continue;
    }
    if (body.isStaticOrKinematicObject()) continue;
    if (!body.isActive()) {
      body.setWorldTransform(motion.start);  // it may have fallen asleep since
      continue;
    }
    // Gravity alone acts through the whole step, so the mean of the velocities carries a free body (exact parabola).
    const btVector3 displacement =
        motion.touches ? motion.moved : (motion.linear + body.getLinearVelocity()) * (btScalar(0.5) * dt);
    const btQuaternion turn = motion.touches ? rotation(motion.turned) : motion.turn;
    body.proceedToTransform(moved(motion.start, displacement, turn));
  }
}

}  // namespace bin_scenes::bullet
