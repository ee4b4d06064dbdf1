/// Bullet's discrete dynamics world with a second-order integrator. Free flight, sliding and rolling then follow their
/// closed forms at any step size, and a body that tumbles freely keeps its energy and angular momentum.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace bin_scenes::bullet {

/// Data of a body that the integrator keeps from the start to the end of a step. It is attached to btRigidBody's user
/// pointer.
struct Motion {
  Vec3 inertia = Vec3::Ones();                     ///< principal moments (Bullet's body frame is the principal frame)
  btVector3 linear{0, 0, 0};                       ///< velocity at the start of the step
  btQuaternion turn{0, 0, 0, 1};                   ///< rotation of torque-free motion over the step
  bool touches = false;                            ///< the contact solver moved it in this step:
  btVector3 moved{0, 0, 0}, turned{0, 0, 0};       ///< displacement and rotation
  btTransform start = btTransform::getIdentity();  ///< pose at the start of the step
  btVector3 ahead_moved{0, 0, 0}, ahead_turned{0, 0, 0};  ///< displacement and turn to where its contacts are found
};

/// Returns null for walls and fixed bodies: Bullet has one solver body for all of them.
Motion* motion_of(const btSolverBody& body);

/// Whether the body is a ball. The lever arms of a ball do not rotate with it, and it rolls freely.
bool is_ball(const btCollisionObject& body);

/// Angle (rad) a body may turn in one torque-free step: Newton converges, and the path of its axis is followed.
constexpr double turn_per_step = 0.1;

/// One step of Euler's equations without torque, I dw/dt = (I w) x w in the body frame, by the implicit midpoint rule,
/// which keeps both quadratic invariants (energy and |L|^2) exactly; returns the angular velocity at the end.
Vec3 torque_free_step(const Vec3& inertia, const Vec3& angular, double dt);

/// Contacts are found where bodies will be at the mean of the sub-steps' beginnings, and have their levers and normals
/// there, as in the symplectic Euler method over the sub-steps, which keeps energy: with those of the start of the step
/// what rocks on an edge gains.
ATTRIBUTE_ALIGNED16(class) DynamicsWorld : public btDiscreteDynamicsWorld {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

  void performDiscreteCollisionDetection() override;

 protected:
  /// Does nothing, because a body on a prescribed motion keeps the velocity that it was given.
  void saveKinematicState(btScalar) override {}
  void predictUnconstraintMotion(btScalar dt) override;
  void integrateTransforms(btScalar dt) override;
};

}  // namespace bin_scenes::bullet
