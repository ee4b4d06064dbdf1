/// What the referee and stock Bullet share: a part as a compound of its exact convex pieces, and a world.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <vector>

namespace bin_scenes::bench {

inline btVector3 to_bt(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline btTransform to_bt(const Pose& pose, double scale = 1.0) {
  const Quat& q = pose.orientation;
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bt(Vec3(pose.position * scale)));
}

/// The pair's friction as every solver of this project takes it.
inline btScalar geometric_mean(const btCollisionObject* a, const btCollisionObject* b) {
  return std::sqrt(a->getFriction() * b->getFriction());
}

/// About the part's centre of mass, in its principal axes; lengths in m times a scale.
struct BulletPart {
  std::vector<std::unique_ptr<btConvexHullShape>> hulls;
  btCompoundShape compound;
  btTransform principal;  ///< principal frame in the model frame
  btVector3 inertia;      ///< at mass 1

  /// @param pieces  vertices of each convex piece (m, model frame)
  BulletPart(const PartModel& part, const std::vector<std::vector<Vec3>>& pieces, double margin, double scale = 1.0) {
    const MassProperties& mass = part.mass();
    principal = to_bt(Pose{mass.center, mass.principal_axes}, scale);
    inertia = to_bt(Vec3(mass.principal * (scale * scale / mass.volume)));
    for (const std::vector<Vec3>& piece : pieces) {
      hulls.push_back(std::make_unique<btConvexHullShape>());
      for (const Vec3& vertex : piece) hulls.back()->addPoint(to_bt(Vec3(vertex * scale)), false);
      hulls.back()->setMargin(margin);
      hulls.back()->recalcLocalAabb();
      compound.addChildShape(principal.inverse(), hulls.back().get());
    }
  }
};

/// With Bullet's sequential impulse solver, fixed bodies, and the project's friction.
struct BulletWorld {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> fixed_shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;

  BulletWorld(const Vec3& gravity, int iterations) {
    gCalculateCombinedFrictionCallback = geometric_mean;
    world.setGravity(to_bt(gravity));
    world.getSolverInfo().m_numIterations = iterations;
  }
  BulletWorld(const BulletWorld&) = delete;
  ~BulletWorld() { clear(); }
  /// Takes all bodies out: who owns their shapes does so before these go.
  void clear() {
    for (const auto& body : bodies)
      if (body) world.removeRigidBody(body.get());
    bodies.clear();
  }
  void add_fixed(std::unique_ptr<btCollisionShape> shape, const Vec3& center, double friction, double restitution) {
    btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shape.get());
    info.m_startWorldTransform.setOrigin(to_bt(center));
    info.m_friction = friction;
    info.m_restitution = restitution;
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
    fixed_shapes.push_back(std::move(shape));
  }
};

}  // namespace bin_scenes::bench
