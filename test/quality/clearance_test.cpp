#include "bin_scenes/quality/quality.hpp"

#include "part/shapes.hpp"
#include "quality/clearance.hpp"
#include "quality/pieces.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

using test::bar;
using test::clearance;

constexpr double infinity = std::numeric_limits<double>::infinity();
const Vec3 down = -Vec3::UnitZ();

Quat turned(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

TEST(Clearance, FacesCornersAndEdges) {
  const MeshQuery box(bar({1, 1, 1}).mesh), rod(bar({1, 0.1, 0.1}).mesh);
  EXPECT_NEAR(clearance(box, {}, box, {Vec3(1.2, 0.1, 0.3), Quat::Identity()}, 1.0), 0.2, 1e-12);
  EXPECT_NEAR(clearance(box, {}, box, {Vec3(1.3, 1.4, 1.0), Quat::Identity()}, 1.0), 0.5, 1e-12);
  const Quat edge_up = turned(M_PI / 4, Vec3::UnitX());
  const Pose across{Vec3(0, 0, 2.0 * std::sqrt(0.5) * 0.1 + 0.03), turned(M_PI / 2, Vec3::UnitZ()) * edge_up};
  EXPECT_NEAR(clearance(rod, {Vec3::Zero(), edge_up}, rod, across, 1.0), 0.03, 1e-12);
}

TEST(Clearance, LimitTouchAndContainment) {
  const MeshQuery box(bar({1, 1, 1}).mesh), small(bar({0.1, 0.1, 0.1}).mesh);
  EXPECT_EQ(clearance(box, {}, box, {Vec3(3, 0, 0), Quat::Identity()}, 0.5), 0.5);
  EXPECT_NEAR(clearance(box, {}, box, {Vec3(1, 0, 0), Quat::Identity()}, 0.5), 0.0, 1e-12);
  EXPECT_EQ(clearance(box, {}, small, {Vec3(0.1, 0, 0), Quat::Identity()}, 0.5), 0.0);
  EXPECT_EQ(clearance(small, {}, box, {Vec3(0.1, 0, 0), Quat::Identity()}, 0.5), 0.0);
}

TEST(Clearance, AgreesWithNearestPointsOfDenseSamples) {
  // Sampled distances are never smaller, and larger by at most the spacing's sagitta.
  const MeshQuery torus(test::torus_mesh(0.4, 0.1, 48, 24)), ball(test::sphere_mesh(0.2, 4));
  Random random(1, 0, Stream::probe);
  for (int i = 0; i < 20; ++i) {
    const Pose a{Vec3::Zero(), random.orientation()}, b{random.orientation() * Vec3(0.9, 0, 0), random.orientation()};
    double sampled = infinity;
    for (const Vec3& v : ball.mesh().vertices) {
      sampled = std::min(sampled, torus.nearest(a.inverse() * (b * v)).distance);
    }
    const double found = clearance(torus, a, ball, b, 2.0);
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GE(found, sampled - 2e-3);
    EXPECT_NEAR(clearance(ball, b, torus, a, 2.0), found, 1e-12);
  }
}

TEST(FreeWay, FacesCornersAndEdges) {
  const MeshQuery box(bar({1, 1, 1}).mesh), rod(bar({1, 0.1, 0.1}).mesh);
  EXPECT_NEAR(free_distance(box, {Vec3(0.3, 0.2, 1.25), turned(0.4, Vec3::UnitZ())}, box, {}, down, infinity), 0.25,
              1e-12);
  const Quat on_corner = Quat::FromTwoVectors(Vec3(1, 1, 1).normalized(), -Vec3::UnitZ());
  EXPECT_NEAR(free_distance(box, {Vec3(0.1, 0.2, 2), on_corner}, box, {}, down, infinity), 1.5 - std::sqrt(0.75),
              1e-12);
  const Quat edge_up = turned(M_PI / 4, Vec3::UnitX());
  const Pose across{Vec3(0, 0, 2.0 * std::sqrt(0.5) * 0.1 + 0.03), turned(M_PI / 2, Vec3::UnitZ()) * edge_up};
  EXPECT_NEAR(free_distance(rod, across, rod, {Vec3::Zero(), edge_up}, down, infinity), 0.03, 1e-12);
}

TEST(FreeWay, NothingBelowBesideOrAbove) {
  const MeshQuery box(bar({1, 1, 1}).mesh);
  EXPECT_EQ(free_distance(box, {Vec3(0, 0, 2), Quat::Identity()}, box, {Vec3(1.1, 0, 0), Quat::Identity()}, down, 9.0),
            9.0);
  EXPECT_EQ(free_distance(box, {}, box, {Vec3(0, 0, 2), Quat::Identity()}, down, 9.0), 9.0);
}

TEST(FreeWay, AlongAnyDirectionAndThroughAHole) {
  const MeshQuery ring(test::ring(0.5, 0.3, 0.1, 24).mesh), rod(bar({0.2, 0.2, 1}).mesh);
  EXPECT_EQ(free_distance(rod, {Vec3(0, 0, 2), Quat::Identity()}, ring, {}, down, 9.0), 9.0);
  const Quat turn = turned(1.0, Vec3(1, 2, 3));
  const Pose motion{Vec3(1, 2, 3), turn};
  EXPECT_NEAR(free_distance(rod, motion * Pose{Vec3(0.4, 0, 2), Quat::Identity()}, ring, motion, turn * down, 9.0),
              1.45, 1e-12);
}

TEST(FreeWay, OverlapAlongTheWayIsZero) {
  const MeshQuery box(bar({1, 1, 1}).mesh);
  EXPECT_EQ(free_distance(box, {Vec3(0.1, 0.2, 0.7), turned(0.3, Vec3(1, 1, 0))}, box, {}, down, 9.0), 0.0);
}

}  // namespace
}  // namespace bin_scenes
