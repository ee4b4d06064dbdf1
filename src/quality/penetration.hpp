/// Computes the overlap of two placed meshes, one of which may be an open surface (a bin). The public function for
/// closed meshes is in quality/quality.hpp.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"
#include "bin_scenes/quality/quality.hpp"

namespace bin_scenes {

struct OverlapSide {
  const MeshQuery& query;
  bool closed = true;         ///< false: an open surface, solid behind the side that faces `front`
  Vec3 front = Vec3::Zero();  ///< open surface only: a point in front of it, in the frame of its mesh
};

Penetration overlap(const OverlapSide& a, const Pose& pose_a, const OverlapSide& b, const Pose& pose_b);

}  // namespace bin_scenes
