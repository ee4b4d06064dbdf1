/// The parts of a scene with their poses, search trees and bounding boxes, as the quality measures use them. The list
/// is made once for a scene and shared by penetration, gap and escaped parts.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <vector>

namespace bin_scenes {

struct Placed {
  const ScenePart* part;
  const MeshQuery* query;
  double diagonal;
  Aabb box;  ///< bin frame
};

/// Two parts, as indices into the list, that overlap, or that touch with less overlap than counts.
struct Overlapping {
  std::size_t a, b;
  Penetration found;  ///< its direction moves b away from a
};

}  // namespace bin_scenes
