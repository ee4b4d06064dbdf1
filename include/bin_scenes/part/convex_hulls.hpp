/// A part as a few convex hulls: cut by planes, or by HACD (Mamou & Ghorbel 2009) where that is better.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

struct HullOptions {
  // Hulls are added until both errors are met or max_hulls is reached.
  double max_error = 0.01;         ///< largest surface error / diagonal
  double max_volume_error = 0.05;  ///< by how much all hulls together may be too large / volume
  int max_hulls = 64;
  int max_vertices = 64;  ///< per hull; a convex part that they do not fit gets up to eight times as many
};

struct ConvexHulls {
  std::vector<Mesh> hulls;  ///< closed convex meshes, model frame, metres
  /// Hausdorff distance / diagonal, larger of hulls' outer surface to mesh and mesh to hulls. Where hulls meet inside
  /// the part is no outer surface.
  double surface_error = 0;
  double volume_error = 0;  ///< (volume of union of hulls - volume) / volume
  bool met = false;         ///< both errors as small as asked for
};

class MeshQuery;

/// One hull if the part is convex enough. Else it is cut by planes into nearly convex pieces, which are merged while
/// the hull of two sticks out of the mesh by less than a share of max_error. Where that misses a goal a smaller share
/// is tried, then HACD's patches. The best result is kept, with `met` telling whether it is good enough.
ConvexHulls convex_hulls(const Mesh& mesh, const HullOptions& options = {});
ConvexHulls convex_hulls(const MeshQuery& query, const HullOptions& options = {});

/// One OBJ with an object per hull (the thesis reuses its hulls this way).
void write_hulls_obj(const ConvexHulls& hulls, const std::string& path);

}  // namespace bin_scenes
