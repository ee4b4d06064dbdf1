/// Convex decomposition of a part: its shape is approximated by a union of convex hulls. The part is cut by planes;
/// HACD (Mamou & Ghorbel 2009) is used where it gives a smaller error. The solver `bullet` and `bin_scenes inspect` use
/// the hulls; the default solver does not.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Limits of the approximation.
struct HullOptions {
  // Hulls are added until both errors are met or max_hulls is reached.
  double max_error = 0.01;         ///< largest error of the surface / diagonal
  double max_volume_error = 0.05;  ///< largest excess of the volume of the union of the hulls / volume of the mesh
  int max_hulls = 64;
  int max_vertices = 64;  ///< limit for one hull; a convex part that needs more gets up to eight times as many
};

/// The hulls, and how well they fit.
struct ConvexHulls {
  std::vector<Mesh> hulls;  ///< closed convex meshes, model frame, metres
  /// The Hausdorff distance / diagonal: the larger of the distances from hulls to mesh and from mesh to hulls. Surfaces
  /// inside the part, where hulls meet, do not count.
  double surface_error = 0;
  double volume_error = 0;  ///< (volume of the union of the hulls - volume of the mesh) / volume of the mesh
  bool met = false;         ///< whether both errors are within the limits of the options
};

class MeshQuery;

/// Returns the convex decomposition of a closed mesh. A nearly convex part gives one hull. Otherwise planes cut it into
/// nearly convex pieces, and two pieces are merged as long as their common hull extends beyond the mesh by less than a
/// share of max_error. If the result does not meet max_error or max_volume_error, a smaller share is tried, and then
/// HACD. The best result is returned; `met` states whether it suffices.
ConvexHulls convex_hulls(const Mesh& mesh, const HullOptions& options = {});
ConvexHulls convex_hulls(const MeshQuery& query, const HullOptions& options = {});

/// Writes an OBJ file with one object for each hull (the thesis stores its hulls in such a file).
void write_hulls_obj(const ConvexHulls& hulls, const std::string& path);

}  // namespace bin_scenes
