/// Planes between two parts: a quick proof that the one does not obstruct the other. When no plane is found, the caller
/// tests the meshes themselves (removal.hpp).
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <limits>

namespace bin_scenes {

/// A mesh at a pose in the bin frame.
struct PlacedMesh {
  const MeshQuery& mesh;
  const Pose& pose;
};

/// Returns the vertex of a mesh that is farthest along a direction (bin frame). The mesh must have triangles.
Vec3 farthest_vertex(const PlacedMesh& mesh, const Vec3& direction);

/// A plane with one body on the side of its normal, and another body on the opposite side.
struct SeparatingPlane {
  Vec3 normal = Vec3::Zero();                             ///< unit normal, bin frame; zero: no plane was found
  double gap = -std::numeric_limits<double>::infinity();  ///< m between both; negative: both cross the plane
};

/// Returns the plane with the largest gap that a short search finds between `other` and `moving` at all positions along
/// its displacement (m). The search ends at a gap of at least -tolerance (m). There may be better planes.
SeparatingPlane separating_plane(const PlacedMesh& moving, const Vec3& displacement, const PlacedMesh& other,
                                 double tolerance);

}  // namespace bin_scenes
