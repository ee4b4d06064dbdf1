/// Makes Bullet's collision shapes of parts and bins: compounds of convex hulls, or planes and boxes. Lengths are those
/// of the scaled world (see bullet_solver.hpp), in which a part has a size of about one.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include <memory>
#include <vector>

namespace bin_scenes::bullet {

/// Bullet's shape of one part in its principal frame (origin: centre of mass; axes: principal axes of the true mesh),
/// with everything the shape points to.
struct PartShape {
  std::unique_ptr<btCollisionShape> shape;
  std::vector<std::unique_ptr<btCollisionShape>> pieces;
  Pose principal;                  ///< principal frame in the model frame, metres
  Vec3 inertia = Vec3::Ones();     ///< principal moments / mass, square units of the scaled world
  double radius = 0.0;             ///< bounding sphere about the centre of mass, units of the scaled world
  double thickness = 1.0;          ///< 2 volume / area (units): thickness of a plate; less than the width of others
  bool hulls_met = true;           ///< whether the hulls meet BulletSettings::hull_error and hull_volume_error
  double hull_error = 0.0;         ///< Hausdorff distance of hulls and mesh / diagonal
  double hull_volume_error = 0.0;  ///< excess volume of the union of the hulls / volume of the mesh
};

/// Makes Bullet's shape of a part. `scale`: units of the scaled world per metre.
PartShape part_shape(const PartModel& part, const BulletSettings& settings, double scale);

/// A triangle mesh that never moves (a bin given as a mesh), in the frame of its file.
struct MeshShape {
  std::unique_ptr<btStridingMeshInterface> triangles;
  std::unique_ptr<btCollisionShape> shape;
};
MeshShape mesh_shape(const Mesh& mesh, double scale);

}  // namespace bin_scenes::bullet
