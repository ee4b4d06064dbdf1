/// Bullet's sequential impulses with three laws put right that the closed forms of docs/measures check:
///   - friction is a cone, not a box: the two tangential impulses of a contact are limited together, so that stick and
///     slip do not depend on how the tangents happen to lie;
///   - friction impulses are warm-started like normal ones, so that a heap does not creep;
///   - a rebound starts at e times the speed of approach, whatever gap was left at that moment, and gravity goes on
///     acting through the step of the impact.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <cstdint>

namespace bin_scenes::bullet {

ATTRIBUTE_ALIGNED16(class) ContactSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Flags of btContactSolverInfo::m_solverMode this solver is written for.
  static constexpr int mode =
      SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;

  std::uint64_t rows = 0;  ///< contacts solved since construction, a counter for the profile

 protected:
  void convertContacts(btPersistentManifold * *manifolds, int count, const btContactSolverInfo& info) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** joints,
                                int joint_count, const btContactSolverInfo& info, btIDebugDraw* draw) override;

 private:
  void warm_start_friction(const btSolverConstraint& contact, btScalar factor);
  void set_rebound(btSolverConstraint & contact, const btContactSolverInfo& info);
  btScalar solve_friction(const btSolverConstraint& contact);
};

}  // namespace bin_scenes::bullet
