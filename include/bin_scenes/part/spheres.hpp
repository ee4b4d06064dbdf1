/// A part as spheres (the shape of the thesis): one per surface voxel; interior voxels get none, they cannot touch.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct Sphere {
  Vec3 center = Vec3::Zero();  ///< model frame (m)
  double radius = 0.0;         ///< m
  Vec3 normal = Vec3::Zero();  ///< true surface's outward normal for spheres on a face; zero on edges and corners
};

struct SphereSet {
  std::vector<Sphere> spheres;
  double pitch = 0.0;  ///< voxel edge (m)
  std::size_t interior_removed = 0;
};

struct VoxelOptions {
  int voxels = 10;         ///< along the longest side of the bounding box
  double tightness = 1.0;  ///< pitch / sphere diameter; < 1 = overlapping spheres
  bool keep_interior = false;
  std::vector<double> radii;  ///< optional, instead of voxels: radii (m), largest first; large spheres fill the inside,
                              ///< small ones the surface
};

class MeshQuery;

/// Voxelises the inside of a closed mesh. A part thinner than one voxel still gets the voxels its surface crosses.
/// The outermost spheres touch the bounding box from inside, whatever the tightness.
SphereSet voxel_spheres(const Mesh& mesh, const VoxelOptions& options);
SphereSet voxel_spheres(const MeshQuery& query, const VoxelOptions& options);

}  // namespace bin_scenes
