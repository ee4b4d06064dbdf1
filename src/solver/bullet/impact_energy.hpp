/// Limits the energy of rebounds. Several impacts within one step have no common instant before them: each contact
/// rebounds with a share of its own approach speed, and together they may return more energy than there was. For
/// example, a ball that rebounded from the floor below another ball, from which it had just separated, doubled the
/// energy of both. Here, bodies that rebound together have at most the energy that they had before.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <utility>
#include <vector>

namespace bin_scenes::bullet {

class ImpactEnergy {
 public:
  /// Call before the rebound. `pairs`: bodies of the pool that rebound together; immovable bodies join no group.
  ImpactEnergy(btAlignedObjectArray<btSolverBody>& bodies, const std::vector<std::pair<int, int>>& pairs);

  /// Call after the rebound. Groups of bodies that gained energy since the start of the step keep as large a share of
  /// the rebound as energy conservation allows. A single body rebounds with the restitution of its contacts.
  void limit();

 private:
  struct Hit {
    int body, group;            ///< index in the pool; index of the first body of its group
    btVector3 linear, angular;  ///< velocities before the rebound, units/s and rad/s
  };
  int place_of(int body);
  int root(int place);

  btAlignedObjectArray<btSolverBody>& bodies_;
  std::vector<Hit> hit_;
  std::vector<int> places_;  ///< by body of the pool: its index in hit_; -1: not in it
};

}  // namespace bin_scenes::bullet
