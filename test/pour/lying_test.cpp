#include "pour/lying.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace bin_scenes::testing {

namespace {

using test::box_mesh;

/// Solid angle of a rectangle, with sides 2a and 2b, seen from a point at a distance d above its centre.
double solid_angle(double a, double b, double d) {
  return 4.0 * std::atan(a * b / (d * std::sqrt(a * a + b * b + d * d)));
}

double lowest_corner(const PartModel& part, const Pose& pose) {
  double lowest = 1e300;
  for (const Vec3& corner : part.corners()) lowest = std::min(lowest, (pose * corner).z());
  return lowest;
}

}  // namespace

/// A box never topples: the share of a face is its solid angle, seen from the centre.
TEST(Lying, ABoxLiesOnAFaceByItsSolidAngle) {
  const Vec3 half(0.05, 0.03, 0.02);
  const PartModelPtr box = PartModel::from_mesh(box_mesh(2.0 * half), "box");
  const LyingPoses lying(*box);
  Random random(4, 0, Stream::pour);
  constexpr int count = 4000;
  std::array<int, 3> on{};
  double turns = 0.0;
  for (int i = 0; i < count; ++i) {
    const Quat turn = lying.draw(random);
    const Vec3 down = turn.conjugate() * -Vec3::UnitZ();
    Vec3::Index axis = 0;
    ASSERT_NEAR(down.cwiseAbs().maxCoeff(&axis), 1.0, 1e-12);
    ++on[static_cast<std::size_t>(axis)];
    const Vec3 beside = turn * Vec3::Unit((axis + 1) % 3);
    turns += std::cos(2.0 * std::atan2(beside.y(), beside.x()));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double share =
        solid_angle(half[(axis + 1) % 3], half[(axis + 2) % 3], half[axis]) / (2.0 * M_PI);  // of two faces
    EXPECT_NEAR(on[static_cast<std::size_t>(axis)], count * share, 4.0 * std::sqrt(count * share * (1.0 - share)));
  }
  EXPECT_NEAR(turns / count, 0.0, 4.0 * std::sqrt(0.5 / count)) << "turned uniformly about the vertical";
}

/// A leaning prism, whose centre of mass is not above its short end faces, never lies on these.
TEST(Lying, APartTopplesFromFacesThatDoNotCarryIt) {
  Mesh mesh = box_mesh({0.02, 0.02, 0.1});
  for (Vec3& vertex : mesh.vertices) vertex.x() += 0.5 * vertex.z();
  const PartModelPtr prism = PartModel::from_mesh(mesh, "prism");
  const LyingPoses lying(*prism);
  Random random(4, 0, Stream::pour);
  for (int i = 0; i < 500; ++i) {
    const Pose pose{Vec3::Zero(), lying.draw(random)};
    ASSERT_LT(std::abs((pose.orientation.conjugate() * Vec3::UnitZ()).z()), 0.9);
    // The centre of mass is within the bounds of what touches the plane, in any direction.
    const double lowest = lowest_corner(*prism, pose);
    const Vec3 center = pose * prism->mass().center;
    for (int k = 0; k < 16; ++k) {
      const Vec3 direction(std::cos(k * M_PI / 8.0), std::sin(k * M_PI / 8.0), 0.0);
      double reach = -1e300;
      for (const Vec3& corner : prism->corners())
        if ((pose * corner).z() < lowest + 1e-9) reach = std::max(reach, direction.dot(pose * corner));
      ASSERT_GT(reach, direction.dot(center)) << i;
    }
  }
}

TEST(Lying, PlacesAreBesideTheBinAndApart) {
  const PartModelPtr box = PartModel::from_mesh(box_mesh({0.06, 0.04, 0.02}), "box");
  const LyingPoses lying(*box);
  Random random(6, 0, Stream::pour);
  Aabb bin;
  bin.extend(Vec3(-0.2, -0.1, -0.005));
  bin.extend(Vec3(0.2, 0.1, 0.1));
  std::vector<Footprint> others;
  for (int i = 0; i < 15; ++i) {
    const auto pose = place_on_table(*box, lying, bin, -0.005, 0.1, others, random);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(lowest_corner(*box, *pose), -0.005, 1e-12);
    const Footprint own = footprint(*box, *pose);
    const Eigen::Vector2d beside = (own.center.cwiseAbs() - Eigen::Vector2d(0.2, 0.1)).cwiseMax(0.0);
    EXPECT_GE(beside.norm(), own.radius);
    EXPECT_LE(beside.norm(), own.radius + 0.1);
    for (const Footprint& other : others) EXPECT_GE((own.center - other.center).norm(), own.radius + other.radius);
    others.push_back(own);
  }
  Aabb nothing;
  nothing.extend(Vec3::Zero());
  others = {{Eigen::Vector2d::Zero(), 1.0}};
  EXPECT_FALSE(place_on_table(*box, lying, nothing, 0.0, 0.1, others, random)) << "another part covers all places";
}

}  // namespace bin_scenes::testing
