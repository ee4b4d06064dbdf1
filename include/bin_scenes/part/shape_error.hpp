/// The error of a collision shape (spheres, distance field, hulls) against the mesh that it stands for. `bin_scenes
/// inspect` and the benchmarks report it; solvers do not use it.
#pragma once

#include "bin_scenes/part/convex_hulls.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "bin_scenes/part/spheres.hpp"

#include <vector>

namespace bin_scenes {

/// One-sided Hausdorff distances between the surface of the collision shape and the mesh: their mean over the area and
/// their maximum, as shares of the diagonal. They are measured by dense sampling, so that a maximum is too small by
/// less than the sampling step, 0.5 % of the diagonal.
struct ShapeError {
  double to_mesh_mean = 0, to_mesh_max = 0;      ///< from the shape to the mesh
  double from_mesh_mean = 0, from_mesh_max = 0;  ///< from the mesh to the shape
  double volume = 0;                             ///< (volume of the shape - volume of the mesh) / volume of the mesh
};

/// Measures a collision shape. @param whole  the same spheres together with those in the interior, by which the volume
/// is measured
ShapeError shape_error(const SphereSet& spheres, const SphereSet& whole, const MeshQuery& query);
ShapeError shape_error(const DistanceField& field, const MeshQuery& query);
ShapeError shape_error(const ConvexHulls& hulls, const MeshQuery& query);

/// A point of a densely sampled surface, with its unit normal.
struct SurfacePoint {
  Vec3 point, normal;
  double weight;  ///< share of the area (m2) that the point represents
};

/// Returns points on every triangle, including its corners, at most `step` (m) apart; at most a million points in
/// addition to the corners.
std::vector<SurfacePoint> dense_surface_points(const Mesh& mesh, double step);

/// Returns the volume of the union of the hulls (m3). If there are several hulls, it is determined by counting points,
/// within about 0.5 %.
double union_volume(const std::vector<Mesh>& hulls);

}  // namespace bin_scenes
