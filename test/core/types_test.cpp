#include "bin_scenes/core/types.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

const Pose quarter_turn{Vec3(1, 2, 3), Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()))};

TEST(Pose, TurnsThenMoves) {
  EXPECT_TRUE((quarter_turn * Vec3(1, 0, 0)).isApprox(Vec3(1, 3, 3), 1e-15));
}

TEST(Pose, ProductIsOneAfterTheOther) {
  const Pose child{Vec3(-2, 0, 1), Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()))};
  const Vec3 point(0.3, -4, 2);
  EXPECT_TRUE(((quarter_turn * child) * point).isApprox(quarter_turn * (child * point), 1e-14));
}

TEST(Pose, InverseTakesBack) {
  const Vec3 point(0.3, -4, 2);
  EXPECT_TRUE((quarter_turn.inverse() * (quarter_turn * point)).isApprox(point, 1e-15));
}

TEST(Pose, OneBadNumberIsNotFinite) {
  Pose pose;
  EXPECT_TRUE(pose.finite());
  pose.orientation.w() = std::nan("");
  EXPECT_FALSE(pose.finite());
}

TEST(Aabb, IsEmptyUntilItHoldsAPoint) {
  Aabb box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diagonal(), 0.0);
  box.extend(Vec3(1, 1, 1));
  EXPECT_FALSE(box.empty());
  box.extend(Vec3(0, 3, -1));
  EXPECT_EQ(box.size(), Vec3(1, 2, 2));
  EXPECT_EQ(box.diagonal(), 3.0);
  EXPECT_EQ(box.center(), Vec3(0.5, 2, 0));
}

TEST(Aabb, OverlapsWithinTheMarginOnEveryAxis) {
  Aabb a, b;
  a.extend(Vec3(0, 0, 0));
  a.extend(Vec3(1, 1, 1));
  b.extend(Vec3(1.5, 0, 0));
  b.extend(Vec3(2, 1, 1));
  EXPECT_FALSE(a.overlaps(b));
  EXPECT_FALSE(a.overlaps(b, 0.49));
  EXPECT_TRUE(a.overlaps(b, 0.5));
  EXPECT_TRUE(b.overlaps(a, 0.5));
}

}  // namespace
}  // namespace bin_scenes
