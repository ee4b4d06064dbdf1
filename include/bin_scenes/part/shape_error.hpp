/// Error of a collision shape (spheres, field, hulls) against the mesh.
#pragma once

#include "bin_scenes/part/convex_hulls.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "bin_scenes/part/spheres.hpp"

#include <vector>

namespace bin_scenes {

/// One-sided Hausdorff distances, mean over the area and maximum, as fractions of the bounding diagonal (measures.md);
/// by dense sampling, so that a maximum is too small by less than the sampling step, 0.5 % of the diagonal.
struct ShapeError {
  double to_mesh_mean = 0, to_mesh_max = 0;      ///< proxy surface -> mesh
  double from_mesh_mean = 0, from_mesh_max = 0;  ///< mesh -> proxy surface
  double volume = 0;                             ///< (proxy - mesh) / mesh
};

/// @param whole  the same set with its interior spheres, by which the volume of the proxy is measured
ShapeError shape_error(const SphereSet& spheres, const SphereSet& whole, const MeshQuery& query);
ShapeError shape_error(const DistanceField& field, const MeshQuery& query);
ShapeError shape_error(const ConvexHulls& hulls, const MeshQuery& query);

/// A point of a surface sampled for measuring.
struct SurfacePoint {
  Vec3 point, normal;
  double weight;  ///< share of the area (m2)
};

/// Points on every triangle, corners included, at most `step` apart; a million of them beside the corners at most.
std::vector<SurfacePoint> dense_surface_points(const Mesh& mesh, double step);

/// Volume of the union of hulls (m3); by counting, within about 0.5 %, where there is more than one.
double union_volume(const std::vector<Mesh>& hulls);

}  // namespace bin_scenes
