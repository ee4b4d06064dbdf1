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
  /// Before the rebound: bodies of the pool that it joins, pair by pair; those that nothing moves join nothing.
  ImpactEnergy(btAlignedObjectArray<btSolverBody>& bodies, const std::vector<std::pair<int, int>>& pairs);

  /// After it: groups of bodies that gained over the start of the step keep as much of the rebound as energy allows. A
  /// body alone rebounds with the restitution of its contacts.
  void limit();

 private:
  struct Hit {
    int body, group;            ///< index in the pool; index of the first body of its group
    btVector3 linear, angular;  ///< before the rebound, units/s and rad/s
  };
  int place_of(int body);
  int root(int place);

  btAlignedObjectArray<btSolverBody>& bodies_;
  std::vector<Hit> hit_;
  std::vector<int> places_;  ///< by body of the pool: its index in hit_; -1: not in it
};

}  // namespace bin_scenes::bullet
