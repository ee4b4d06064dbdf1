/// Converts vectors and poses between the library's types and Bullet's, without changing the scale. The scale in which
/// Bullet simulates small parts is applied by the callers (world.hpp).
#pragma once

#include "bin_scenes/core/types.hpp"

#include <LinearMath/btTransform.h>

namespace bin_scenes::bullet {

static_assert(sizeof(btScalar) == sizeof(double), "link Bullet's float64 libraries and define BT_USE_DOUBLE_PRECISION");

inline btVector3 to_bt(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 from_bt(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
inline btQuaternion to_bt(const Quat& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline Quat from_bt(const btQuaternion& q) {
  return Quat(q.w(), q.x(), q.y(), q.z());
}
inline btTransform to_bt(const Pose& pose) {
  return btTransform(to_bt(pose.orientation), to_bt(pose.position));
}
inline Pose from_bt(const btTransform& t) {
  return {from_bt(t.getOrigin()), from_bt(t.getRotation()).normalized()};
}

}  // namespace bin_scenes::bullet
