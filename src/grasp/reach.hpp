/// Collisions of a gripper on its path to a part and out of the bin. It tests the swept bodies of gripper_shape.hpp
/// against the obstacles of placed_parts.hpp, and does not ask whether the grasp holds (holding.hpp).
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

#include <vector>

namespace bin_scenes {

/// Tests all grasps of one part by one gripper for collisions with the surroundings of the part.
class Reach {
 public:
  /// @param lift  unit direction in which the part is lifted, bin frame
  Reach(const PlacedParts& placed, const PlacedPart& part, const Gripper& gripper, const Vec3& lift);

  /// Returns whether the gripper, grown by its clearance, collides with other parts or the bin while it approaches,
  /// closes or is lifted. Sets SceneGrasp::obstacle and other if it does.
  bool meets(SceneGrasp& grasp) const;
  /// Returns the column `clearance` of a free grasp: 0, or 0.5 if twice the clearance is free, or 1 if four times is.
  double room(const SceneGrasp& grasp) const;

 private:
  bool check(const std::vector<Sweep>& sweeps, SceneGrasp::Obstacle where, SceneGrasp& grasp) const;
  double height_to_top(const SceneGrasp& grasp) const;
  double way_back(const SceneGrasp& grasp) const;

  const PlacedParts& placed_;
  const Gripper& gripper_;
  const Vec3 lift_;
  std::vector<std::size_t> order_;  ///< indices of all other parts and the bin, the nearest ones first
};

}  // namespace bin_scenes
