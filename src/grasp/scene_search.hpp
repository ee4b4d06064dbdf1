/// The search for grasps of one part in a scene, from vertical approaches to tilted ones, as deep as the floor and the
/// neighbours permit. It proposes poses; callbacks of the caller decide whether they are reached and free.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

#include <functional>

namespace bin_scenes {

/// A pose that the search tries.
struct SearchedPose {
  const Grasp& grasp;
  Pose pose;            ///< pose of the gripper in the bin frame
  std::size_t of = 0;   ///< suction: index of the grasp in PartGrasps::grasps
  bool listed = false;  ///< whether it is one of PartGrasps::placed, which are tried in every scene
};
/// Callback that returns whether a grasp is free, and stores the grasp if it is.
using KeepIfFree = std::function<bool(const SearchedPose& tried)>;
/// For fingers: callback that returns whether a pose (bin frame) is reached; called before contact is measured.
using IsReached = std::function<bool(const Pose& pose, const Aperture& at)>;

struct SearchedPart {
  const PlacedParts& placed;
  const PlacedPart& part;
  const PartModel& model;
  const Gripper& gripper;
  const PartGrasps& grasps;
  double friction;  ///< friction coefficient between gripper and part
};

/// Searches for grasps of one part in a scene. For fingers, the closing axes of the part are kept; approach, turn and
/// depth are sampled. For cups, all places on the part are tried. The search ends after Gripper::free_wanted free
/// grasps, no two of which are similar, or after Gripper::tries poses. The result does not depend on Gripper::most.
PartSearch search_scene(const SearchedPart& searched, const IsReached& is_reached, const KeepIfFree& keep);

}  // namespace bin_scenes
