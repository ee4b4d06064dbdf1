/// Makes the bodies of a gripper for a simulated world: fingers or ring, and palm, in the gripper frame
/// (scene/gripper.hpp). The simulated lift of pour/prover.hpp uses them.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/gripper.hpp"

#include <vector>

namespace bin_scenes {

struct GripperBody {
  PartModelPtr model;
  Pose pose;  ///< from the model to the gripper frame; for fingers, at an opening of 0
};

/// Returns two fingers, the one at -x first, or a ring; the palm is the last body.
std::vector<GripperBody> bodies_of(const Gripper& gripper);

}  // namespace bin_scenes
