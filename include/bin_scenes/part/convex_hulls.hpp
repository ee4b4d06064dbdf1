/// Convex decomposition of a part: by planes, or by HACD (Mamou & Ghorbel 2009) where that gives a smaller error.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

struct HullOptions {
  // Hulls are added until both errors are met or max_hulls is reached.
  double max_error = 0.01;         ///< largest surface error / diagonal
  double max_volume_error = 0.05;  ///< largest excess volume of the union of the hulls / volume of the mesh
  int max_hulls = 64;
  int max_vertices = 64;  ///< per hull; a convex part that they do not fit gets up to eight times as many
};

struct ConvexHulls {
  std::vector<Mesh> hulls;  ///< closed convex meshes, model frame, metres
  /// Hausdorff distance / diagonal, the larger one of hulls to mesh and mesh to hulls. Surfaces where hulls meet
  /// inside the part do not count.
  double surface_error = 0;
  double volume_error = 0;  ///< (volume of union of hulls - volume) / volume
  bool met = false;         ///< both errors are within the options
};

class MeshQuery;

/// A nearly convex part gives one hull. Otherwise planes cut it into nearly convex pieces, and two pieces are merged
/// while their common hull exceeds the mesh by less than a share of max_error. If the result misses max_error or
/// max_volume_error, a smaller share is tried, then HACD. The best result is kept; `met` says whether it suffices.
ConvexHulls convex_hulls(const Mesh& mesh, const HullOptions& options = {});
ConvexHulls convex_hulls(const MeshQuery& query, const HullOptions& options = {});

/// One OBJ with an object per hull (the thesis reuses its hulls from such a file).
void write_hulls_obj(const ConvexHulls& hulls, const std::string& path);

}  // namespace bin_scenes
