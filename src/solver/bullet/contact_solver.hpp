/// Contacts of one island, solved in sub-steps: Bullet finds them (one collision detection per step) and sets up their
/// rows; this class replaces Bullet's sweeps, and its integration of bodies in contact.
///
///   for each sub-step h:  gravity -> warm start -> sweeps with soft push-out -> move -> sweeps without (relaxation)
///   at the end of the step: rebound
///
/// Between detections, separations are updated with the Jacobians of the rows. Many small steps converge better than
/// many sweeps of one large step: loads propagate through a stack of ten in a few steps (Macklin et al. 2019, "Small
/// steps in physics simulation"). Soft push-out with relaxation removes overlap without adding speed (Catto 2024,
/// "Solver2D"). With Bullet's own sweeps, of which 20 to 200 iterations at 240 to 1000 Hz were tried, a stack of ten
/// boxes sways and falls.
///
/// Contacts that press within a small patch of each other resist rotation together, as in the sphere solver
/// (src/solver/sphere/passes/solve.cpp, resist_turn).
///
/// Friction is a cone: both tangential impulses of a contact are limited together. The initial speed of a rebound is
/// the restitution times the approach speed just before the contact first pushed.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <cstdint>
#include <vector>

namespace bin_scenes::bullet {

/// Data of a body from the start to the end of a step (dynamics_world.hpp); btRigidBody's user pointer points to it.
struct Motion;

ATTRIBUTE_ALIGNED16(class) ContactSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Number of sweeps of a sub-step before bodies move, and again after. With one sweep, stacks of three cubes and of
  /// ten rings tremble.
  static constexpr int sweeps = 2;

  /// Sets flags and numbers of btContactSolverInfo for this solver; m_numIterations is the number of sub-steps.
  static void configure(btContactSolverInfo & info);

  /// Radius (units) of the patch of a contact at a point or along a line; the patch resists spin and rolling.
  btScalar patch_radius = 0;

  std::uint64_t rows = 0;  ///< contacts solved since construction, a counter for the profile

  /// Contact of all steps with the largest depth / smaller diagonal (units). Bodies are numbered by getUserIndex2().
  struct Deepest {
    int a = -1, b = -1;
    btScalar depth = 0, relative = 0;  ///< units; depth / smaller diagonal
    double time = 0;                   ///< s, value of `clock` in that step
    std::uint64_t unresolved_impacts = 0;
  };
  std::vector<btScalar> diagonals;
  double clock = 0;  ///< s of simulated time, advanced by the world
  Deepest deepest;

 protected:
  void convertContacts(btPersistentManifold * *manifolds, int count, const btContactSolverInfo& info) override;
  btScalar solveGroupCacheFriendlyIterations(
      btCollisionObject * *bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
      btTypedConstraint** joints, int joint_count, const btContactSolverInfo& info, btIDebugDraw* draw) override;

 private:
  struct Contact {
    btVector3 place;    ///< position of the contact, from the centre of mass of its first body (units)
    btScalar distance;  ///< distance at the time of detection (units)
    btScalar approach;  ///< normal velocity before the first push (units/s), negative
    bool pushed;
    btScalar lasting;  ///< normal impulse at the start of the sub-step
  };
  /// Displacement and rotation of a solver body since the contacts were detected.
  struct Displacement {
    btVector3 moved{0, 0, 0}, turned{0, 0, 0};
    bool touches = false;
  };

  /// Push-out in a sub-step: ratio of speed to overlap (1/s), and the shares of mass and impulse that act.
  struct Soft {
    btScalar rate, mass_share, impulse_share;
  };

  /// Pushing removes overlap; relaxing removes the velocity that this has added.
  enum class Sweep { first_push, push, relax };

  void note_depth(const btPersistentManifold& manifold);
  void begin();
  void forget_impacts(btScalar speed);
  void warm_start();
  /// Sweeps over all contacts, or over those of bodies that the last sweep left unconverged. Returns whether any
  /// remain.
  bool sweep(btScalar h, Sweep kind, bool all);
  void resist_turn(int first, int last);
  btScalar solve_normal(int contact, btScalar h, const Soft* soft);
  void solve_friction(const btSolverConstraint& contact);
  void move(btScalar h);
  void rebound(const btContactSolverInfo& info);
  void hand_over();

  std::vector<Contact> contacts_;  ///< indexed like m_tmpSolverContactConstraintPool
  std::vector<int> blocks_;        ///< by pair of bodies: its first contact; at the end, the number of contacts
  std::vector<char> unconverged_, were_unconverged_;  ///< by body: whether one of its contacts has not converged, in
                                                      ///< this sweep and in the previous one
  std::vector<Displacement> displacements_;           ///< indexed like m_tmpSolverBodyPool
};

}  // namespace bin_scenes::bullet
