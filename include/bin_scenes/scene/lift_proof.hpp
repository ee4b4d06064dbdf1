/// The result of simulating one grasp in a copy of its heap. Prover (pour/prover.hpp) produces it, and grasps.json
/// reports it. It describes whether the part was lifted, and what happened to the other parts.
#pragma once

#include <vector>

namespace bin_scenes {

/// The outcome of one simulated grasp, with the motion of the gripped part and the ids of other parts that it
/// disturbed.
struct LiftProof {
  enum class Outcome {
    lifted,   ///< the part is in the gripper, above the heap, and no other part came with it
    missed,   ///< the fingers closed without touching the part
    slipped,  ///< the part slipped out of the gripper
    jammed,   ///< the part slipped out while other parts held it back with more than its own weight
    dragged   ///< the part was lifted, and other parts came with it
  } outcome = Outcome::lifted;
  double slip = 0.0;  ///< m, displacement of the centre of mass relative to the gripper, from the moment the gripper
                      ///< held the part until the end or the loss of the part
  double turn = 0.0;  ///< rad, rotation relative to the gripper over the same time
  std::vector<int> dragged;  ///< ids of other parts that rose by at least half of the lift, ascending
  std::vector<int> moved;    ///< ids of other parts that moved by at least 5 % of their diagonal or turned by at least
                             ///< 0.1 rad, ascending
};

const char* name_of(LiftProof::Outcome outcome);

}  // namespace bin_scenes
