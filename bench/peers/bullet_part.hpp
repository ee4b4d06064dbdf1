/// What the referee and stock Bullet share: a part as a compound of its exact convex pieces.
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

}  // namespace bin_scenes::bench
