/// A part as a few convex hulls, by HACD (Mamou & Ghorbel 2009). Only the source file sees HACD.
#pragma once

#include "bin_scenes/scene/mesh.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

struct HullOptions {
  double max_error =
      0.01;  ///< largest surface error / diagonal; hulls are added until it is met or max_hulls is reached
  int max_hulls = 64;
  int max_vertices = 64;  ///< per hull
};

struct ConvexHulls {
  std::vector<Mesh> hulls;   ///< closed convex meshes, model frame, metres
  double surface_error = 0;  ///< one-sided Hausdorff, hulls' outer surface to mesh / diagonal
  double volume_error = 0;   ///< (volume of union of hulls - volume) / volume
  bool met = false;          ///< error goal reached
};

class MeshQuery;

/// One hull if the part is convex enough. Else patches by HACD, merged while the hull of two sticks out of the mesh by
/// less than max_error; starts from few patches and takes more until the measured error meets the goal. The best result
/// is kept, with `met` telling whether it is good enough.
ConvexHulls convex_hulls(const Mesh& mesh, const HullOptions& options = {});
ConvexHulls convex_hulls(const MeshQuery& query, const HullOptions& options = {});

/// One OBJ with an object per hull (the thesis reuses its hulls this way).
void write_hulls_obj(const ConvexHulls& hulls, const std::string& path);

}  // namespace bin_scenes
