#include "impact_energy.hpp"

#include "convert.hpp"
#include "dynamics_world.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bullet {

namespace {

/// Twice the kinetic energy that two velocities of a body have in common: the bilinear form of mass and inertia.
btScalar twice_common(const btSolverBody& body, const btVector3& linear_a, const btVector3& angular_a,
                      const btVector3& linear_b, const btVector3& angular_b) {
  const btMatrix3x3& axes = body.getWorldTransform().getBasis();
  const Vec3& i = motion_of(body)->inertia;
  const btVector3 inertia(btScalar(i.x()), btScalar(i.y()), btScalar(i.z()));
  return linear_a.dot(linear_b) / body.internalGetInvMass().x() +
         (angular_a * axes).dot(inertia * (angular_b * axes));  // v * axes: in the body's frame
}

btVector3 linear_of(const btSolverBody& body) {
  return body.m_linearVelocity + body.m_deltaLinearVelocity;
}
btVector3 angular_of(const btSolverBody& body) {
  return body.m_angularVelocity + body.m_deltaAngularVelocity;
}

/// Twice the energy at the start of the step, or with what the step's forces add: whichever is more, as the impact came
/// between them.
btScalar twice_before(const btSolverBody& body) {
  const btVector3 &v = body.m_linearVelocity, &w = body.m_angularVelocity, later = v + body.m_externalForceImpulse;
  return std::max(twice_common(body, v, w, v, w), twice_common(body, later, w, later, w));
}

}  // namespace

ImpactEnergy::ImpactEnergy(btAlignedObjectArray<btSolverBody>& bodies, const std::vector<std::pair<int, int>>& pairs)
    : bodies_(bodies), places_(static_cast<std::size_t>(bodies.size()), -1) {
  for (const auto& [a, b] : pairs) {
    const int at_a = place_of(a), at_b = place_of(b);
    if (at_a >= 0 && at_b >= 0) hit_[root(at_b)].group = root(at_a);
  }
}

int ImpactEnergy::place_of(int body) {
  int& place = places_[body];
  if (place >= 0 || !motion_of(bodies_[body])) return place;
  place = static_cast<int>(hit_.size());
  hit_.push_back({body, place, linear_of(bodies_[body]), angular_of(bodies_[body])});
  return place;
}

int ImpactEnergy::root(int place) {
  while (hit_[place].group != place) place = hit_[place].group;
  return place;
}

void ImpactEnergy::limit() {
  // Energy over the share s of the rebound: left + 2 s mixed + s^2 gained.
  struct Energy {
    btScalar before = 0, left = 0, mixed = 0, gained = 0;
    int bodies = 0;
  };
  std::vector<Energy> groups(hit_.size());
  for (std::size_t k = 0; k < hit_.size(); ++k) {
    const Hit& b = hit_[k];
    const btSolverBody& body = bodies_[b.body];
    const btVector3 linear = linear_of(body) - b.linear, angular = angular_of(body) - b.angular;
    Energy& e = groups[root(static_cast<int>(k))];
    e.before += twice_before(body);
    e.left += twice_common(body, b.linear, b.angular, b.linear, b.angular);
    e.mixed += twice_common(body, b.linear, b.angular, linear, angular);
    e.gained += twice_common(body, linear, angular, linear, angular);
    ++e.bodies;
  }
  for (std::size_t k = 0; k < hit_.size(); ++k) {
    const Hit& b = hit_[k];
    const Energy& e = groups[root(static_cast<int>(k))];
    const btScalar added = 2 * e.mixed + e.gained;  // what pushing overlap out has added is not the rebound's
    if (e.bodies < 2 || added <= 0 || e.left + added <= e.before) continue;
    const btScalar room = std::max(btScalar(0), e.before - e.left);
    const btScalar share = (std::sqrt(e.mixed * e.mixed + e.gained * room) - e.mixed) / e.gained;
    btSolverBody& body = bodies_[b.body];
    const btScalar back = std::min(std::max(share, btScalar(0)), btScalar(1)) - 1;
    body.m_deltaLinearVelocity += back * (linear_of(body) - b.linear);
    body.m_deltaAngularVelocity += back * (angular_of(body) - b.angular);
  }
}

}  // namespace bin_scenes::bullet
