/// The bin of a world, which never moves: a floor, floor and walls, or a mesh.
#include "convert.hpp"
#include "world.hpp"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <algorithm>

namespace bin_scenes::bullet {

namespace {

// Lengths in units of the scaled world: the median part's diagonal is 1.
constexpr double wall_size = 4.0;  ///< thickness of walls and floor: nothing gets through
// Half the edge of an endless floor. At 3e5 the rounding of its contacts lets a box creep on a slope it should rest on.
constexpr double endless = 1e4;

}  // namespace

void World::add_static(btCollisionShape* shape, const btTransform& pose) {
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shape);
  info.m_startWorldTransform = pose;
  info.m_friction = def_.bin.friction;
  info.m_restitution = def_.bin.restitution;
  walls_.push_back(std::make_unique<btRigidBody>(info));
  world_.addRigidBody(walls_.back().get());
}

void World::add_walls(double wall_height) {
  const auto box = [&](const Vec3& lower, const Vec3& upper) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < 8; ++i)
      shape->addPoint(
          to_bt(Vec3((i & 1 ? upper : lower).x(), (i & 2 ? upper : lower).y(), (i & 4 ? upper : lower).z())), false);
    shape->setMargin(0.0);
    shape->recalcLocalAabb();
    shape->initializePolyhedralFeatures();
    add_static(shape.get(), btTransform::getIdentity());
    wall_shapes_.push_back(std::move(shape));
  };
  switch (def_.bin.kind) {
    case Bin::Kind::none:
      return;
    case Bin::Kind::floor:
      box({-endless, -endless, -wall_size}, {endless, endless, 0});
      return;
    case Bin::Kind::mesh: {
      bin_mesh_ = mesh_shape(def_.bin_model->mesh(), scale_);
      add_static(bin_mesh_.shape.get(), to_bt(Pose{def_.bin.pose.position * scale_, def_.bin.pose.orientation}));
      return;
    }
    case Bin::Kind::box: {
      const double x = 0.5 * def_.bin.inner_size.x() * scale_, y = 0.5 * def_.bin.inner_size.y() * scale_;
      const double z = std::max(wall_height, def_.bin.inner_size.z()) * scale_, t = wall_size;
      box({-x - t, -y - t, -t}, {x + t, y + t, 0});
      box({-x - t, -y - t, 0}, {-x, y + t, z});
      box({x, -y - t, 0}, {x + t, y + t, z});
      box({-x - t, -y - t, 0}, {x + t, -y, z});
      box({-x - t, y, 0}, {x + t, y + t, z});
      return;
    }
  }
}

}  // namespace bin_scenes::bullet
