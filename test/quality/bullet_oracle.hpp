/// Penetration depth by an independent engine: Bullet's GJK and EPA in double precision, without margins, as the
/// largest over all pairs of convex pieces.
#pragma once

#include "pieces.hpp"

#include <memory>

namespace bin_scenes::test {

class BulletPieces {
 public:
  explicit BulletPieces(const Body& body);
  ~BulletPieces();
  BulletPieces(BulletPieces&&) noexcept;

  friend double bullet_depth(const BulletPieces& a, const Pose& pose_a, const BulletPieces& b, const Pose& pose_b);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

double bullet_depth(const BulletPieces& a, const Pose& pose_a, const BulletPieces& b, const Pose& pose_b);

}  // namespace bin_scenes::test
