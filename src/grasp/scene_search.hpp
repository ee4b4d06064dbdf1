/// Grasps that are looked for where a part lies, when it is not covered: from vertical approaches outwards, down to the
/// floor and the neighbours.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

#include <functional>

namespace bin_scenes {

/// A pose that the search tries.
struct SearchedPose {
  const Grasp& grasp;
  Pose pose;            ///< of the gripper in the bin frame
  std::size_t of = 0;   ///< suction: index into PartGrasps::grasps
  bool listed = false;  ///< every scene tries it anyway
};
/// Decides whether a grasp is free, and keeps it if so.
using KeepIfFree = std::function<bool(const SearchedPose& tried)>;

struct SearchedPart {
  const PlacedParts& placed;
  const PlacedPart& part;
  const PartModel& model;
  const Gripper& gripper;
  const PartGrasps& grasps;
  double friction;  ///< of gripper and part
};

/// Fingers: closing axes of the part are kept; approach, turn and depth are sampled. Cups: all places on the part. Ends
/// after Gripper::free_wanted free grasps, no two of which are alike, or Gripper::tries poses. Deterministic, and
/// independent of Gripper::most.
PartSearch search_scene(const SearchedPart& searched, const KeepIfFree& keep);

}  // namespace bin_scenes
