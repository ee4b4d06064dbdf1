/// Which parts obstruct the lift of others, and an order in which all parts can be lifted. Parts are lifted straight
/// along a direction; grippers are not considered here.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

namespace bin_scenes {

/// Returns load, pull, lift, blocking parts and overlaps of all movable parts. order_removal() fills in their depths.
std::vector<PartPick> picks_of(const Scene& scene, const LoadedRequest& loaded, const PlacedParts& placed);

/// Fills in the depths, and returns the order of removal of all parts. Adds to `sets` the smallest sets of parts that
/// block each other: each part of a set is blocked, directly or through others, by all parts of it.
std::vector<int> order_removal(std::vector<PartPick>& picks, const PlacedParts& placed,
                               std::vector<SceneGrasps::HeldSet>& sets);

/// Returns whether `other` obstructs a movement of `part` along `direction` (unit vector) by `limit` (m).
bool hinders(const PlacedPart& other, const PlacedPart& part, const Vec3& direction, double limit);

}  // namespace bin_scenes
