#include "shape.hpp"

#include "convert.hpp"
#include "polyhedron.hpp"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>

#include <algorithm>

namespace bin_scenes::bullet {

namespace {

/// Margins only keep GJK away from touching cores; hulls with polyhedral features report distances without them, so
/// the outer surface is the true one whatever the margin is.
std::unique_ptr<btCollisionShape> hull_shape(Mesh hull, const Pose& from_model, double scale, double margin) {
  constexpr double flat = 1e-5;  // units of the scaled world
  for (Vec3& v : hull.vertices) v = scale * (from_model * v);
  auto shape = std::make_unique<btConvexHullShape>();
  for (const Vec3& v : hull.vertices) shape->addPoint(to_bt(v), false);
  shape->setMargin(margin);
  shape->recalcLocalAabb();
  btConvexPolyhedron faces = polyhedron_of(hull, flat);
  shape->setPolyhedralFeatures(faces);
  return shape;
}

/// A tessellated sphere about its centre of mass, given by its vertices and its volume: hulls of few vertices would not
/// roll. Radius in metres, 0 if it is none.
double sphere_radius(const PartModel& part, double tolerance) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& v : part.mesh().vertices) nearest = std::min(nearest, (v - part.mass().center).norm());
  const double radius = part.radius(), ball = 4.0 / 3.0 * M_PI * radius * radius * radius;
  const bool round = nearest > (1.0 - 1e-3) * radius && part.mass().volume > (1.0 - 3.0 * 2.0 * tolerance) * ball;
  return round ? radius : 0.0;
}

}  // namespace

PartShape part_shape(const PartModel& part, const BulletSettings& settings, double scale) {
  const MassProperties& mass = part.mass();
  PartShape result;
  result.principal = {mass.center, mass.principal_axes};
  result.inertia = mass.principal / mass.volume * (scale * scale);
  result.radius = part.radius() * scale;
  result.thickness = 2.0 * mass.volume / mass.area * scale;
  if (const double radius = sphere_radius(part, settings.hull_error); radius > 0.0) {
    result.shape = std::make_unique<btSphereShape>(radius * scale);
    return result;
  }

  HullOptions options;
  options.max_error = settings.hull_error;
  options.max_volume_error = settings.hull_volume_error;
  options.max_hulls = settings.max_hulls;
  const ConvexHulls& hulls = part.hulls(options);
  result.hulls_met = hulls.met;
  result.hull_error = hulls.surface_error;
  result.hull_volume_error = hulls.volume_error;
  const Pose from_model = result.principal.inverse();
  const double margin = settings.margin * part.diagonal() * scale;
  for (const Mesh& hull : hulls.hulls) result.pieces.push_back(hull_shape(hull, from_model, scale, margin));
  auto compound = std::make_unique<btCompoundShape>(true, static_cast<int>(result.pieces.size()));
  compound->setMargin(margin);
  for (const auto& piece : result.pieces) compound->addChildShape(btTransform::getIdentity(), piece.get());
  result.shape = std::move(compound);
  return result;
}

MeshShape mesh_shape(const Mesh& mesh, double scale) {
  MeshShape result;
  auto triangles = std::make_unique<btTriangleMesh>();
  for (const Triangle& t : mesh.triangles)
    triangles->addTriangle(to_bt(Vec3(scale * mesh.vertices[t[0]])), to_bt(Vec3(scale * mesh.vertices[t[1]])),
                           to_bt(Vec3(scale * mesh.vertices[t[2]])));
  result.shape = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
  result.shape->setMargin(0.0);
  result.triangles = std::move(triangles);
  return result;
}

}  // namespace bin_scenes::bullet
