/// Faces of a convex hull as Bullet clips them against each other.
#pragma once

#include "bin_scenes/scene/mesh.hpp"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>

namespace bin_scenes::bullet {

/// @param hull convex, closed; its triangles wind outwards
/// Triangles in one plane, up to `flat` in the hull's unit, are one face. Bullet's own initializePolyhedralFeatures
/// leaves them triangles where the face has corners along a straight edge: what lies on the face of a bolt's head then
/// touches in one triangle after the other, and corners are met when they are already under.
btConvexPolyhedron polyhedron_of(const Mesh& hull, double flat);

}  // namespace bin_scenes::bullet
