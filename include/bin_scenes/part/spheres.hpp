/// The collision shape of the thesis: a part as spheres, one for each voxel at the surface. Voxels in the interior get
/// no sphere, because nothing can touch them. Only the solver `thesis` uses these spheres; the default solver uses
/// samples and a distance field.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// A sphere of the collision shape, in the model frame.
struct Sphere {
  Vec3 center = Vec3::Zero();  ///< centre in the model frame (m)
  double radius = 0.0;         ///< radius (m)
  Vec3 normal = Vec3::Zero();  ///< outward normal of the true surface for spheres on a face; zero for spheres on edges
                               ///< and corners
};

/// All spheres of a part.
struct SphereSet {
  std::vector<Sphere> spheres;
  double pitch = 0.0;  ///< edge length of a voxel (m)
  std::size_t interior_removed = 0;
};

/// Resolution of the voxels.
struct VoxelOptions {
  int voxels = 10;         ///< number along the longest side of the bounding box
  double tightness = 1.0;  ///< pitch / diameter of a sphere; values below 1 make spheres overlap
  bool keep_interior = false;
  std::vector<double> radii;  ///< alternative to `voxels`: radii (m), largest first; large spheres fill the interior
                              ///< and small ones the surface
};

class MeshQuery;

/// Voxelises the interior of a closed mesh. A part thinner than one voxel still gets the voxels that its surface
/// crosses. The outermost spheres touch the bounding box from inside, whatever the tightness.
SphereSet voxel_spheres(const Mesh& mesh, const VoxelOptions& options);
SphereSet voxel_spheres(const MeshQuery& query, const VoxelOptions& options);

}  // namespace bin_scenes
