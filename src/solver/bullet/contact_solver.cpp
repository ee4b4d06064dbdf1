/// Replaces the sweeps of Bullet's solver by sub-steps with soft contacts, a cone of friction and one rebound. Bullet
/// keeps collision detection, islands and rows.
#include "contact_solver.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"

#include "dynamics_world.hpp"
#include "impact_energy.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bullet {

namespace {

// Soft push-out (Catto 2011, "Soft constraints", eqs for a damped oscillator): a quarter of the sub-step rate is as
// stiff as stays stable; at critical damping a light part under one a thousand times as heavy is pressed through.
constexpr btScalar stiffness = 0.25, damping_ratio = 2.0;
/// Units left overlapping. With none, contacts at rest open and close from step to step, and twenty rings hop higher
/// and higher; ten boxes sink by it, by a quarter of what they may drift.
constexpr btScalar slop = 1.5e-5;
constexpr btScalar fastest_push = 3.0;  ///< units/s
/// A contact whose speed a sweep still changes by more (units/s) is not solved: an impact that two walls of a wedge
/// share takes dozens of sweeps. After two it left overlap, and the speed at which this was pushed out.
constexpr btScalar tolerance = 0.02;
constexpr int most_sweeps = 40;         ///< for such, instead of `sweeps`
constexpr btScalar force_growth = 1.5;  ///< of a contact in a sub-step; with more, heaps rebound from an impact

/// What a moment about `axis` turns a body by; nothing of what is fixed.
btVector3 turned_by(const btSolverBody& body, const btVector3& axis) {
  return body.m_originalBody ? body.m_originalBody->getInvInertiaTensorWorld() * axis : btVector3(0, 0, 0);
}

bool is_no_ball(const btSolverBody& body) {
  return !body.m_originalBody || !is_ball(*body.m_originalBody);
}

btScalar velocity(const btSolverBody& a, const btSolverBody& b, const btSolverConstraint& row) {
  return row.m_contactNormal1.dot(a.m_linearVelocity + a.m_deltaLinearVelocity) +
         row.m_relpos1CrossNormal.dot(a.m_angularVelocity + a.m_deltaAngularVelocity) +
         row.m_contactNormal2.dot(b.m_linearVelocity + b.m_deltaLinearVelocity) +
         row.m_relpos2CrossNormal.dot(b.m_angularVelocity + b.m_deltaAngularVelocity);
}

void apply(btSolverBody& a, btSolverBody& b, const btSolverConstraint& row, btScalar impulse) {
  a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
  b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
}

/// Adds to a row's impulse, keeps the sum from pulling, and lets both bodies feel what was added.
void push(btSolverBody& a, btSolverBody& b, btSolverConstraint& row, btScalar impulse) {
  const btScalar before = row.m_appliedImpulse, after = std::max(btScalar(0), before + impulse);
  row.m_appliedImpulse = after;
  apply(a, b, row, after - before);
}

}  // namespace

void ContactSolver::configure(btContactSolverInfo& info) {
  info.m_solverMode =
      SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  info.m_warmstartingFactor = 0.0;  // this solver warm-starts each sub-step itself
  info.m_splitImpulse = false;
}

/// Contacts are found where bodies are halfway through the step, which is taken back here.
void ContactSolver::note_depth(const btPersistentManifold& manifold) {
  const btCollisionObject* bodies[] = {manifold.getBody0(), manifold.getBody1()};
  for (int p = 0; p < manifold.getNumContacts(); ++p) {
    const btManifoldPoint& point = manifold.getContactPoint(p);
    btScalar gap = point.getDistance(), diagonal = BT_LARGE_FLOAT;
    btScalar sign = -1;
    for (const btCollisionObject* body : bodies) {
      const int index = body->getUserIndex2();
      if (index >= 0) diagonal = std::min(diagonal, diagonals[static_cast<std::size_t>(index)]);
      if (const auto* motion = static_cast<const Motion*>(body->getUserPointer())) {
        const btVector3 arm = point.getPositionWorldOnB() - body->getWorldTransform().getOrigin();
        gap += sign * point.m_normalWorldOnB.dot(motion->ahead_moved + motion->ahead_turned.cross(arm));
      }
      sign = 1;
    }
    if (-gap <= deepest.relative * diagonal) continue;
    deepest.a = bodies[0]->getUserIndex2();
    deepest.b = bodies[1]->getUserIndex2();
    deepest.depth = -gap;
    deepest.relative = -gap / diagonal;
    deepest.time = clock;
  }
}

void ContactSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  for (int m = 0; m < count; ++m) note_depth(*manifolds[m]);
  // The tangents a point got when it was found stay its tangents (the flag keeps Bullet from choosing new ones), so
  // that the impulses along them mean the same in the next step. Both bodies are pushed at one and the same point,
  // halfway across the gap or overlap: a pair of friction forces along two lines would be a torque from nowhere.
  for (int m = 0; m < count; ++m)
    for (int p = 0; p < manifolds[m]->getNumContacts(); ++p) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(p);
      point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
      point.m_positionWorldOnA = point.m_positionWorldOnB =
          (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * btScalar(0.5);
    }
  btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
}

btScalar ContactSolver::solveGroupCacheFriendlyIterations(btCollisionObject**, int, btPersistentManifold**, int,
                                                          btTypedConstraint**, int, const btContactSolverInfo& info,
                                                          btIDebugDraw*) {
  begin();
  const int steps = info.m_numIterations;
  const btScalar h = info.m_timeStep / steps;
  const btScalar impact = 2 * info.m_restitutionVelocityThreshold / steps;  // what falls for four sub-steps
  for (int s = 0; s < steps; ++s) {
    for (int b = 0; b < m_tmpSolverBodyPool.size(); ++b)
      m_tmpSolverBodyPool[b].m_deltaLinearVelocity += m_tmpSolverBodyPool[b].m_externalForceImpulse / steps;
    forget_impacts(impact);
    warm_start();
    stop_if_cancelled();
    const auto sweep_until_shared = [&](Sweep first, Sweep others) {
      bool more = true;
      for (int k = 0; k < sweeps || (more && k < most_sweeps); ++k)
        more = sweep(h, k == 0 ? first : others, k < sweeps);
      return !more;
    };
    deepest.unresolved_impacts += !sweep_until_shared(Sweep::first_push, Sweep::push);
    move(h);
    sweep_until_shared(Sweep::relax, Sweep::relax);
  }
  rebound(info);
  forget_impacts(impact);
  hand_over();
  return 0;
}

void ContactSolver::begin() {
  const int count = m_tmpSolverContactConstraintPool.size();
  BIN_SCENES_ASSERT(m_tmpSolverContactFrictionConstraintPool.size() == 2 * count);
  rows += static_cast<std::uint64_t>(count);
  contacts_.resize(static_cast<std::size_t>(count));
  displacements_.assign(static_cast<std::size_t>(m_tmpSolverBodyPool.size()), Displacement());
  for (int b = 0; b < m_tmpSolverBodyPool.size(); ++b) {
    const Motion* motion = motion_of(m_tmpSolverBodyPool[b]);
    if (motion) displacements_[b] = {-motion->ahead_moved, -motion->ahead_turned, false};
  }
  blocks_.clear();
  for (int c = 0; c < count; ++c) {
    btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
    const auto& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    const btVector3 origin = m_tmpSolverBodyPool[row.m_solverBodyIdA].getWorldTransform().getOrigin();
    contacts_[c] = {point.getPositionWorldOnA() - origin, point.getDistance(), 0, point.m_appliedImpulse > 0,
                    point.m_appliedImpulse};
    row.m_appliedImpulse = point.m_appliedImpulse;
    m_tmpSolverContactFrictionConstraintPool[row.m_frictionIndex].m_appliedImpulse = point.m_appliedImpulseLateral1;
    m_tmpSolverContactFrictionConstraintPool[row.m_frictionIndex + 1].m_appliedImpulse = point.m_appliedImpulseLateral2;
    if (c == 0 || row.m_solverBodyIdA != m_tmpSolverContactConstraintPool[c - 1].m_solverBodyIdA ||
        row.m_solverBodyIdB != m_tmpSolverContactConstraintPool[c - 1].m_solverBodyIdB)
      blocks_.push_back(c);
    displacements_[row.m_solverBodyIdA].touches = displacements_[row.m_solverBodyIdB].touches = true;
  }
  blocks_.push_back(count);
  BIN_SCENES_ASSERT(count == 0 || ascends(blocks_));
}

/// A force may grow by half in a sub-step, and by what stops `speed`. Beyond, the impulse was that of an impact: it is
/// over, and the next sub-step does not begin with it. A few sweeps do not take it back from a heap, which would be
/// thrown up.
void ContactSolver::forget_impacts(btScalar speed) {
  if (speed == 0) return;  // without weight nothing distinguishes a force from an impact
  for (int c = 0; c < m_tmpSolverContactConstraintPool.size(); ++c) {
    btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
    const btScalar most = force_growth * contacts_[c].lasting + speed * row.m_jacDiagABInv;
    if (row.m_appliedImpulse > most) {
      const btScalar share = most / row.m_appliedImpulse;
      row.m_appliedImpulse *= share;
      for (int k = 0; k < 2; ++k)
        m_tmpSolverContactFrictionConstraintPool[row.m_frictionIndex + k].m_appliedImpulse *= share;
    }
    contacts_[c].lasting = row.m_appliedImpulse;
  }
}

void ContactSolver::warm_start() {
  const auto first = [&](const btSolverConstraint& row) -> btSolverBody& {
    return m_tmpSolverBodyPool[row.m_solverBodyIdA];
  };
  const auto second = [&](const btSolverConstraint& row) -> btSolverBody& {
    return m_tmpSolverBodyPool[row.m_solverBodyIdB];
  };
  // All of them before any force acts: between forces, bodies have speeds that they never had.
  for (int c = 0; c < m_tmpSolverContactConstraintPool.size(); ++c) {
    const btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
    if (!contacts_[c].pushed) contacts_[c].approach = velocity(first(row), second(row), row);
  }
  for (int c = 0; c < m_tmpSolverContactConstraintPool.size(); ++c) {
    const btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
    btSolverBody &a = first(row), &b = second(row);
    apply(a, b, row, row.m_appliedImpulse);
    for (int k = 0; k < 2; ++k) {
      const btSolverConstraint& tangent = m_tmpSolverContactFrictionConstraintPool[row.m_frictionIndex + k];
      apply(a, b, tangent, tangent.m_appliedImpulse);
    }
  }
}

bool ContactSolver::sweep(btScalar h, Sweep kind, bool all) {
  const btScalar omega = 2 * SIMD_PI * stiffness / h;
  const btScalar a1 = 2 * damping_ratio + h * omega, a2 = h * omega * a1, a3 = 1 / (1 + a2);
  const Soft soft{omega / a1, a2 * a3, a3};
  unconverged_.swap(were_unconverged_);
  unconverged_.assign(static_cast<std::size_t>(m_tmpSolverBodyPool.size()), 0);
  bool more = false;
  // Normal and friction pair of bodies by pair of bodies: a stack of ten stands so with a third of the sweeps it takes
  // when all normals come before all friction. Turning every other sweep round made it fall.
  for (std::size_t k = 0; k + 1 < blocks_.size(); ++k) {
    const btSolverConstraint& first = m_tmpSolverContactConstraintPool[blocks_[k]];
    const int bodies[] = {first.m_solverBodyIdA, first.m_solverBodyIdB};
    if (!all && !were_unconverged_[bodies[0]] && !were_unconverged_[bodies[1]]) continue;
    if (kind == Sweep::first_push) resist_turn(blocks_[k], blocks_[k + 1]);
    btScalar changed = 0;
    for (int c = blocks_[k]; c < blocks_[k + 1]; ++c)
      changed = std::max(changed, solve_normal(c, h, kind == Sweep::relax ? nullptr : &soft));
    for (int c = blocks_[k]; c < blocks_[k + 1]; ++c) solve_friction(m_tmpSolverContactConstraintPool[c]);
    if (changed <= tolerance) continue;
    more = true;
    for (const int body : bodies) unconverged_[body] = m_tmpSolverBodyPool[body].m_originalBody != nullptr;
  }
  return more;
}

/// A patch resists spin about its normal by 2/3 of its radius times friction, and is tipped over its rim by its radius
/// times the force. Contacts that lie farther apart do so themselves. Once a sub-step, when the forces of all contacts
/// have begun: before, turns are those of a body in the air.
void ContactSolver::resist_turn(int first, int last) {
  const btSolverConstraint& row = m_tmpSolverContactConstraintPool[first];
  btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  btScalar impulse = 0;
  btVector3 center(0, 0, 0), normal(0, 0, 0);
  for (int c = first; c < last; ++c) {
    const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[c];
    impulse += contact.m_appliedImpulse;
    center += contacts_[c].place * btScalar(contact.m_appliedImpulse);
    normal += contact.m_contactNormal1 * btScalar(contact.m_appliedImpulse);
  }
  if (!(impulse > 0) || normal.fuzzyZero()) return;
  center /= impulse;
  normal.normalize();
  const btVector3 turn =
      a.m_angularVelocity + a.m_deltaAngularVelocity - b.m_angularVelocity - b.m_deltaAngularVelocity;
  const btScalar spin = normal.dot(turn);
  btVector3 tip = turn - spin * normal;
  const btScalar tipping = tip.length();
  if (tipping > 0) tip /= tipping;
  const btVector3 across = normal.cross(tip);
  btScalar spread = 0, spread_across = 0;  // squares of lengths, times impulse
  for (int c = first; c < last; ++c) {
    const btVector3 off = contacts_[c].place - center;
    const btScalar side = across.dot(off), pressed = m_tmpSolverContactConstraintPool[c].m_appliedImpulse;
    spread += pressed * off.length2();
    spread_across += pressed * side * side;
  }
  const btScalar widest = 4 * patch_radius * patch_radius * impulse;
  const auto resist = [&](const btVector3& axis, btScalar speed, btScalar most) {
    const btVector3 turn_a = turned_by(a, axis), turn_b = turned_by(b, axis);
    const btScalar k = axis.dot(turn_a + turn_b);
    if (!(k > 0)) return;
    const btScalar moment = std::min(std::max(speed / k, -most), most);
    a.m_deltaAngularVelocity -= turn_a * moment;
    b.m_deltaAngularVelocity += turn_b * moment;
  };
  const btScalar friction = m_tmpSolverContactFrictionConstraintPool[row.m_frictionIndex].m_friction;
  if (spread <= widest) resist(normal, spin, btScalar(2.0 / 3.0) * patch_radius * friction * impulse);
  if (spread_across <= widest && is_no_ball(a) && is_no_ball(b)) resist(tip, tipping, patch_radius * impulse);
}

btScalar ContactSolver::solve_normal(int c, btScalar h, const Soft* soft) {
  btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
  btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  const Displacement &moved_a = displacements_[row.m_solverBodyIdA], &moved_b = displacements_[row.m_solverBodyIdB];
  const btScalar gap = contacts_[c].distance + row.m_contactNormal1.dot(moved_a.moved) +
                       row.m_relpos1CrossNormal.dot(moved_a.turned) + row.m_contactNormal2.dot(moved_b.moved) +
                       row.m_relpos2CrossNormal.dot(moved_b.turned);
  btScalar bias = 0, mass_share = 1, impulse_share = 0;
  if (gap > 0) {
    bias = gap / h;  // may close by the end of the sub-step, no further
  } else if (soft) {
    bias = std::max(soft->rate * std::min(gap + slop, btScalar(0)), -fastest_push);
    mass_share = soft->mass_share;
    impulse_share = soft->impulse_share;
  }
  const btScalar before = row.m_appliedImpulse;
  push(
      a, b, row,
      -row.m_jacDiagABInv * mass_share * (velocity(a, b, row) + bias) - impulse_share * btScalar(row.m_appliedImpulse));
  if (btScalar(row.m_appliedImpulse) > 0) contacts_[c].pushed = true;
  return std::abs(btScalar(row.m_appliedImpulse) - before) / row.m_jacDiagABInv;
}

void ContactSolver::solve_friction(const btSolverConstraint& contact) {
  btSolverConstraint& u = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex];
  btSolverConstraint& v = m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex + 1];
  btSolverBody& a = m_tmpSolverBodyPool[u.m_solverBodyIdA];
  btSolverBody& b = m_tmpSolverBodyPool[u.m_solverBodyIdB];
  // One step length for both rows: with two, the impulse would not end up opposite to the slip, because a body yields
  // more easily in some directions than in others.
  const btScalar step = std::min(u.m_jacDiagABInv, v.m_jacDiagABInv);
  const btScalar before_u = u.m_appliedImpulse, before_v = v.m_appliedImpulse;
  btScalar after_u = before_u - step * velocity(a, b, u), after_v = before_v - step * velocity(a, b, v);
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
}

void ContactSolver::move(btScalar h) {
  for (int b = 0; b < m_tmpSolverBodyPool.size(); ++b) {
    const btSolverBody& body = m_tmpSolverBodyPool[b];
    if (!body.m_originalBody) continue;
    displacements_[b].moved += (body.m_linearVelocity + body.m_deltaLinearVelocity) * h;
    displacements_[b].turned += (body.m_angularVelocity + body.m_deltaAngularVelocity) * h;
  }
}

void ContactSolver::rebound(const btContactSolverInfo& info) {
  std::vector<int> bouncing;
  for (int c = 0; c < m_tmpSolverContactConstraintPool.size(); ++c) {
    const auto& point =
        *static_cast<const btManifoldPoint*>(m_tmpSolverContactConstraintPool[c].m_originalContactPoint);
    if (point.m_combinedRestitution > 0 && contacts_[c].pushed &&
        contacts_[c].approach < -info.m_restitutionVelocityThreshold)
      bouncing.push_back(c);
  }
  if (bouncing.empty()) return;
  constexpr int sweeps = 20;  // several points of one face share the rebound
  std::vector<btScalar> carried;
  std::vector<std::pair<int, int>> pairs;
  for (const int c : bouncing) {
    const btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
    carried.push_back(row.m_appliedImpulse);
    pairs.emplace_back(row.m_solverBodyIdA, row.m_solverBodyIdB);
  }
  ImpactEnergy energy(m_tmpSolverBodyPool, pairs);
  for (int s = 0; s < sweeps; ++s)
    for (const int c : bouncing) {
      btSolverConstraint& row = m_tmpSolverContactConstraintPool[c];
      const auto& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
      btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
      btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
      push(a, b, row,
           -row.m_jacDiagABInv * (velocity(a, b, row) + point.m_combinedRestitution * contacts_[c].approach));
    }
  energy.limit();
  // A rebound happens once: the next step must not start from its impulse.
  for (std::size_t k = 0; k < bouncing.size(); ++k)
    m_tmpSolverContactConstraintPool[bouncing[k]].m_appliedImpulse = carried[k];
}

void ContactSolver::hand_over() {
  for (int b = 0; b < m_tmpSolverBodyPool.size(); ++b) {
    btSolverBody& body = m_tmpSolverBodyPool[b];
    if (!body.m_originalBody) continue;
    body.m_externalForceImpulse.setZero();  // already in the velocity, sub-step by sub-step
    Motion* motion = motion_of(body);
    if (!motion) continue;
    motion->touches = displacements_[b].touches;
    motion->moved = motion->ahead_moved + displacements_[b].moved;
    motion->turned = motion->ahead_turned + displacements_[b].turned;
  }
}

}  // namespace bin_scenes::bullet
