/// Planes between parts, and exact distances that are searched with their help.
#include "grasp/separation.hpp"

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

TEST(SeparatingPlane, OfTwoBoxesHasTheGapOfTheirFaces) {
  const MeshQuery box(test::box_mesh({0.02, 0.02, 0.02}));
  const Pose here{}, beside{Vec3(0.025, 0.004, -0.003), Quat::Identity()}, above{Vec3(0, 0, 0.05), Quat::Identity()},
      below{Vec3(0.001, 0.002, -0.0205), Quat::Identity()};
  const Vec3 lift(0, 0, 0.1);
  const auto gap = [&](const Pose& other, double tolerance) {
    const SeparatingPlane plane = separating_plane({box, here}, lift, {box, other}, tolerance);
    EXPECT_TRUE(plane.gap < -tolerance || plane.normal.dot(lift) >= -tolerance);
    return plane.gap;
  };
  EXPECT_GT(gap(beside, 0.0), 0.0);
  EXPECT_LE(gap(beside, 0.0), 0.005 + 1e-12);
  EXPECT_GT(gap(below, 0.0), 0.0);
  EXPECT_LE(gap(below, 0.0), 0.0005 + 1e-12);
  EXPECT_LT(gap(above, 0.0), 0.0);  // the lift ends above it
  // Overlapped by 0.1 mm: separated with this tolerance, and not without it.
  const Pose overlapped{Vec3(0.0199, 0.003, 0.001), Quat::Identity()};
  EXPECT_LT(gap(overlapped, 0.0), 0.0);
  EXPECT_GE(gap(overlapped, 2e-4), -2e-4);
}

TEST(SeparatingPlane, TheFarthestVertexIsThatOfAllVertices) {
  const MeshQuery torus(test::torus_mesh(0.4, 0.1, 40, 20));
  Random random(3, 0, Stream::probe);
  for (int i = 0; i < 200; ++i) {
    const Pose pose{random.orientation() * Vec3(0.3, 0, 0), random.orientation()};
    const Vec3 direction = random.orientation() * Vec3::UnitX();
    double expected = -1.0;
    for (const Vec3& v : torus.mesh().vertices) expected = std::max(expected, direction.dot(pose * v));
    EXPECT_NEAR(direction.dot(farthest_vertex({torus, pose}, direction)), expected, 1e-12);
  }
}

TEST(SeparatingPlane, APartThatItSeparatesMovesFreely) {
  // And as a guide, it leaves exact distances as they are.
  const MeshQuery torus(test::torus_mesh(0.4, 0.1, 24, 12)), box(test::box_mesh({0.9, 0.3, 0.2}));
  Random random(4, 0, Stream::probe);
  int separated = 0, guided = 0, met = 0;
  for (int i = 0; i < 400; ++i) {
    const Pose a{random.orientation() * Vec3(random.uniform(0.0, 1.0), 0, 0), random.orientation()};
    const Pose b{random.orientation() * Vec3(0.1, 0, 0), random.orientation()};
    const Vec3 direction = random.orientation() * Vec3::UnitX();
    const SeparatingPlane plane = separating_plane({torus, a}, 3.0 * direction, {box, b}, 0.0);
    const double free = free_distance(torus, a, box, b, direction, 3.0);
    met += free < 3.0;
    if (plane.gap >= 0.0) {
      ++separated;
      EXPECT_EQ(free, 3.0) << i;
    } else if (plane.normal.dot(direction) >= 0.0) {
      ++guided;
      EXPECT_EQ(free_distance(torus, a, box, b, direction, 3.0, plane.normal), free) << i;
    }
  }
  EXPECT_GT(separated, 40);
  EXPECT_GT(guided, 100);
  EXPECT_GT(met, 100);
}

}  // namespace
}  // namespace bin_scenes
