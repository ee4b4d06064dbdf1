/// The search for grasps of one part in a scene: from vertical approaches outwards, down to the floor and the
/// neighbours. It proposes poses, and calls of the caller decide whether they are reached and free.
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
  bool listed = false;  ///< it is one of PartGrasps::placed, which every scene tries
};
/// Decides whether a grasp is free, and keeps it if so.
using KeepIfFree = std::function<bool(const SearchedPose& tried)>;
/// Fingers: whether the gripper reaches a pose in the bin frame. Asked before the contact is measured.
using IsReached = std::function<bool(const Pose& pose, const Aperture& at)>;

struct SearchedPart {
  const PlacedParts& placed;
  const PlacedPart& part;
  const PartModel& model;
  const Gripper& gripper;
  const PartGrasps& grasps;
  double friction;  ///< of gripper and part
};

/// Fingers: the closing axes of the part are kept; approach, turn and depth are sampled. Cups: all places on the part
/// are tried. The search ends after Gripper::free_wanted free grasps, no two of which are similar, or after
/// Gripper::tries poses. The result depends on the arguments only, and not on Gripper::most.
PartSearch search_scene(const SearchedPart& searched, const IsReached& is_reached, const KeepIfFree& keep);

}  // namespace bin_scenes
