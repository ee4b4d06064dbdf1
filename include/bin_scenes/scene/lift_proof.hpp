/// The result of a grasp that was simulated in a copy of its heap.
#pragma once

#include <vector>

namespace bin_scenes {

struct LiftProof {
  enum class Outcome {
    lifted,   ///< it is in the gripper, over the heap, and alone
    missed,   ///< the fingers closed on nothing
    slipped,  ///< the gripper lost it
    jammed,   ///< the same, while others pulled it down with more than its weight
    dragged   ///< it came, and others with it
  } outcome = Outcome::lifted;
  double slip = 0.0;         ///< m: of its centre of mass in the gripper, from when that held it; until it was lost
  double turn = 0.0;         ///< rad: likewise, of its turn
  std::vector<int> dragged;  ///< ids of other parts that came up with it, by half of the lift or more; ascending
  std::vector<int> moved;    ///< of those that moved by 5 % of their diagonal or turned by 0.1 rad; ascending
};

const char* name_of(LiftProof::Outcome outcome);

}  // namespace bin_scenes
