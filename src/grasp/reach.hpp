/// What a gripper meets on its path to a part and away from it.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

#include <vector>

namespace bin_scenes {

/// One part among the others, for all grasps of a gripper.
class Reach {
 public:
  /// @param lift  unit: direction in which the part is lifted
  Reach(const PlacedParts& placed, const PlacedPart& part, const Gripper& gripper, const Vec3& lift);

  /// Whether the gripper, grown by its clearance, meets others or the bin as it comes, closes or goes up; says where
  /// and whom in the grasp.
  bool meets(SceneGrasp& grasp) const;
  /// Room beside a free grasp: 0 where only its clearance is free, 0.5 where twice that is, 1 where four times that is.
  double room(const SceneGrasp& grasp) const;

 private:
  bool check(const std::vector<Sweep>& sweeps, SceneGrasp::Obstacle where, SceneGrasp& grasp) const;
  double height_to_top(const SceneGrasp& grasp) const;
  double way_back(const SceneGrasp& grasp) const;

  const PlacedParts& placed_;
  const Gripper& gripper_;
  const Vec3 lift_;
  std::vector<std::size_t> order_;  ///< of all others, the nearest first
};

}  // namespace bin_scenes
