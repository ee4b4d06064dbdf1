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
  bool touches = false;                            ///< whether the contact solver moved it in this step
  btVector3 moved{0, 0, 0}, turned{0, 0, 0};       ///< displacement and rotation by the contact solver
  btTransform start = btTransform::getIdentity();  ///< pose at the start of the step
  btVector3 ahead_moved{0, 0, 0}, ahead_turned{0, 0, 0};  ///< displacement and rotation to the pose of detection
};

/// Returns null for walls and fixed bodies: Bullet has one solver body for all of them.
Motion* motion_of(const btSolverBody& body);

/// Whether the body is a ball. The lever arms of a ball do not rotate with it, and it rolls freely.
bool is_ball(const btCollisionObject& body);

/// Rotation (rad) of a torque-free step: with this limit, Newton's iteration converges and the axis' path is resolved.
constexpr double turn_per_step = 0.1;

/// Integrates Euler's equations without torque, I dw/dt = (I w) x w in the body frame, over `dt` by the implicit
/// midpoint rule, which conserves energy and |L|^2 exactly. Returns the angular velocity at the end.
Vec3 torque_free_step(const Vec3& inertia, const Vec3& angular, double dt);

/// Finds contacts at the poses that bodies will have at the mean of the times at which the sub-steps begin, and uses
/// the lever arms and normals of these poses. This is the symplectic Euler method over the sub-steps, which conserves
/// energy; with the poses at the start of the step, a body that rocks on an edge gains energy.
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
