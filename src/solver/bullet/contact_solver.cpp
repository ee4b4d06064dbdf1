#include "contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bullet {

namespace {

/// Impulse that takes away a row's velocity error, before any limit.
btScalar wanted(const btSolverBody& a, const btSolverBody& b, const btSolverConstraint& row) {
  const btScalar velocity =
      row.m_contactNormal1.dot(a.getDeltaLinearVelocity()) + row.m_relpos1CrossNormal.dot(a.getDeltaAngularVelocity()) +
      row.m_contactNormal2.dot(b.getDeltaLinearVelocity()) + row.m_relpos2CrossNormal.dot(b.getDeltaAngularVelocity());
  return row.m_rhs - btScalar(row.m_appliedImpulse) * row.m_cfm - velocity * row.m_jacDiagABInv;
}

void apply(btSolverBody& a, btSolverBody& b, const btSolverConstraint& row, btScalar impulse) {
  a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
  b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
}

}  // namespace

void ContactSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  // The tangents a point got when it was found stay its tangents (the flag keeps Bullet from choosing new ones), so
  // that the impulses along them mean the same in the next step. Both bodies are pushed at one and the same point,
  // half-way across the gap or overlap: a pair of friction forces along two lines would be a torque from nowhere.
  for (int m = 0; m < count; ++m)
    for (int p = 0; p < manifolds[m]->getNumContacts(); ++p) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(p);
      point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
      point.m_positionWorldOnA = point.m_positionWorldOnB =
          (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * btScalar(0.5);
    }

  const int first = m_tmpSolverContactConstraintPool.size();
  btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
  for (int c = first; c < m_tmpSolverContactConstraintPool.size(); ++c) {
    warm_start_friction(m_tmpSolverContactConstraintPool[c], info.m_warmstartingFactor);
    set_rebound(m_tmpSolverContactConstraintPool[c], info);
  }
  rows += static_cast<std::uint64_t>(m_tmpSolverContactConstraintPool.size() - first);
}

void ContactSolver::warm_start_friction(const btSolverConstraint& contact, btScalar factor) {
  const auto& point = *static_cast<const btManifoldPoint*>(contact.m_originalContactPoint);
  const btScalar last[2] = {point.m_appliedImpulseLateral1, point.m_appliedImpulseLateral2};
  for (int k = 0; k < 2; ++k) {
    btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex + k];
    if (btScalar(row.m_appliedImpulse) != 0) continue;  // some versions of Bullet warm-start friction themselves
    row.m_appliedImpulse = last[k] * factor;
    apply(m_tmpSolverBodyPool[row.m_solverBodyIdA], m_tmpSolverBodyPool[row.m_solverBodyIdB], row, last[k] * factor);
  }
}

void ContactSolver::set_rebound(btSolverConstraint& contact, const btContactSolverInfo& info) {
  const auto& point = *static_cast<const btManifoldPoint*>(contact.m_originalContactPoint);
  if (point.m_combinedRestitution <= 0) return;
  const btSolverBody& a = m_tmpSolverBodyPool[contact.m_solverBodyIdA];
  const btSolverBody& b = m_tmpSolverBodyPool[contact.m_solverBodyIdB];
  const btScalar approach =
      contact.m_contactNormal1.dot(a.m_linearVelocity) + contact.m_relpos1CrossNormal.dot(a.m_angularVelocity) +
      contact.m_contactNormal2.dot(b.m_linearVelocity) + contact.m_relpos2CrossNormal.dot(b.m_angularVelocity);
  if (approach > -info.m_restitutionVelocityThreshold) return;
  contact.m_rhs = (-point.m_combinedRestitution * approach - approach) * contact.m_jacDiagABInv;
}

btScalar ContactSolver::solveSingleIteration(int iteration, btCollisionObject**, int, btPersistentManifold**, int,
                                             btTypedConstraint**, int, const btContactSolverInfo&, btIDebugDraw*) {
  // Sweeps alternate their direction (symmetric Gauss-Seidel), so that load travels through a heap both ways.
  const int count = m_tmpSolverContactConstraintPool.size();
  const auto order = [&](int k) { return iteration % 2 == 0 ? k : count - 1 - k; };
  btScalar worst = 0;
  for (int k = 0; k < count; ++k) {
    btSolverConstraint& row = m_tmpSolverContactConstraintPool[order(k)];
    btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    const btScalar before = row.m_appliedImpulse;
    const btScalar after = std::max(btScalar(0), before + wanted(a, b, row));
    row.m_appliedImpulse = after;
    apply(a, b, row, after - before);
    worst = std::max(worst, std::abs(after - before) / row.m_jacDiagABInv);
  }
  for (int k = 0; k < count; ++k) worst = std::max(worst, solve_friction(m_tmpSolverContactConstraintPool[order(k)]));
  return worst * worst;  // Bullet stops when this falls below m_leastSquaresResidualThreshold
}

btScalar ContactSolver::solve_friction(const btSolverConstraint& contact) {
  btSolverConstraint& u = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex];
  btSolverConstraint& v = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex + 1];
  btSolverBody& a = m_tmpSolverBodyPool[u.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[u.m_solverBodyIdB];
  // One step length for both rows: with two, the impulse would not end up opposite to the slip, because a body yields
  // more easily in some directions than in others.
  const btScalar step = std::min(u.m_jacDiagABInv, v.m_jacDiagABInv);
  const btScalar before_u = u.m_appliedImpulse, before_v = v.m_appliedImpulse;
  btScalar after_u = before_u + wanted(a, b, u) * (step / u.m_jacDiagABInv);
  btScalar after_v = before_v + wanted(a, b, v) * (step / v.m_jacDiagABInv);
  const btScalar limit = u.m_friction * btScalar(contact.m_appliedImpulse);
  const btScalar length = std::sqrt(after_u * after_u + after_v * after_v);
  if (length > limit) {
    after_u *= limit / length;
    after_v *= limit / length;
  }
  u.m_appliedImpulse = after_u;
  v.m_appliedImpulse = after_v;
  apply(a, b, u, after_u - before_u);
  apply(a, b, v, after_v - before_v);
  return std::max(std::abs(after_u - before_u), std::abs(after_v - before_v)) / step;
}

}  // namespace bin_scenes::bullet
