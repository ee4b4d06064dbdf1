/// What hinders parts from being lifted straight up, and in which order they come free.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "grasp/placed_parts.hpp"

namespace bin_scenes {

/// Picks of all movable parts, without depth: load, pull and what blocks them.
std::vector<PartPick> picks_of(const Scene& scene, const LoadedRequest& loaded, const PlacedParts& placed);

/// Fills in the depths, and returns the order of all parts and the sets that leave together. A set is as small as can
/// be: each of its parts is held, through others, by every one of them.
std::vector<int> order_removal(std::vector<PartPick>& picks, const PlacedParts& placed,
                               std::vector<SceneGrasps::HeldSet>& sets);

/// Whether `other` obstructs `part` as it goes along `direction` (unit) up to `limit` (m).
bool hinders(const PlacedPart& other, const PlacedPart& part, const Vec3& direction, double limit);

}  // namespace bin_scenes
