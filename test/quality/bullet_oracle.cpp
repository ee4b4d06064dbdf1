#include "bullet_oracle.hpp"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>

namespace bin_scenes::test {

struct BulletPieces::State {
  std::vector<std::unique_ptr<btConvexHullShape>> hulls;
};

BulletPieces::BulletPieces(const Body& body) : state_(std::make_unique<State>()) {
  for (const std::vector<Vec3>& piece : body.pieces) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& x : piece) hull->addPoint(btVector3(x.x(), x.y(), x.z()), false);
    hull->setMargin(0.0);
    hull->recalcLocalAabb();
    state_->hulls.push_back(std::move(hull));
  }
}
BulletPieces::~BulletPieces() = default;
BulletPieces::BulletPieces(BulletPieces&&) noexcept = default;

double bullet_depth(const BulletPieces& a, const Pose& pose_a, const BulletPieces& b, const Pose& pose_b) {
  const auto transform = [](const Pose& p) {
    const Quat& q = p.orientation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()),
                       btVector3(p.position.x(), p.position.y(), p.position.z()));
  };
  const btTransform ta = transform(pose_a), tb = transform(pose_b);
  double worst = 0.0;
  for (const auto& ha : a.state_->hulls) {
    btVector3 al, ah;
    ha->getAabb(ta, al, ah);
    for (const auto& hb : b.state_->hulls) {
      btVector3 bl, bh;
      hb->getAabb(tb, bl, bh);
      if (al.x() > bh.x() || al.y() > bh.y() || al.z() > bh.z() || bl.x() > ah.x() || bl.y() > ah.y() ||
          bl.z() > ah.z()) {
        continue;
      }
      btGjkEpaSolver2::sResults result;
      if (btGjkEpaSolver2::Penetration(ha.get(), ta, hb.get(), tb, ta.getOrigin() - tb.getOrigin(), result)) {
        worst = std::max(worst, static_cast<double>(-result.distance));
      }
    }
  }
  return worst;
}

}  // namespace bin_scenes::test
