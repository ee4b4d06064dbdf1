/// The faces of a convex hull in the form in which Bullet clips them against each other. Triangles in one plane become
/// one face. Bullet's own function splits some planes, and contacts then miss corners.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>

namespace bin_scenes::bullet {

/// Returns the faces of a hull. Triangles in one plane, up to `flat` (unit of the hull), are one face. Bullet's own
/// initializePolyhedralFeatures splits some planes; clipping then misses corners, so that a bolt that rolls on the rim
/// of its head gets contacts at corners that already overlap, and gains energy (docs/lab/findings/bullet.md).
/// @param hull  convex, closed; its triangles wind outwards
btConvexPolyhedron polyhedron_of(const Mesh& hull, double flat);

}  // namespace bin_scenes::bullet
