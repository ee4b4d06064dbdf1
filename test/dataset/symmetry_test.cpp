/// Symmetries and diameters of parts for which they are known.
#include "bin_scenes/part/symmetry.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace bin_scenes {
namespace {

PartModelPtr sample(const std::string& name) {
  LoadOptions options;
  options.unit = Unit::millimetre;
  return PartModel::load(std::string(std::getenv("BIN_SCENES_MODELS")) + "/" + name + ".stl", options);
}

TEST(Symmetry, OfSampleParts) {
  const Symmetries ring = find_symmetries(*sample("washer"));
  ASSERT_EQ(ring.continuous.size(), 1u);
  EXPECT_NEAR(std::abs(ring.continuous[0].direction.z()), 1.0, 1e-6);
  EXPECT_EQ(ring.discrete.size(), 1u);  // over

  const Symmetries nut = find_symmetries(*sample("nut_hex"));
  EXPECT_TRUE(nut.continuous.empty());
  EXPECT_EQ(nut.discrete.size(), 11u);  // of a hexagonal prism

  const Symmetries mug = find_symmetries(*sample("mug"));
  EXPECT_TRUE(mug.continuous.empty());
  EXPECT_TRUE(mug.discrete.empty());
}

TEST(Symmetry, MapsThePartOntoItself) {
  const PartModelPtr nut = sample("nut_hex");
  for (const Pose& turn : find_symmetries(*nut).discrete) {
    for (const Vec3& vertex : nut->mesh().vertices)
      ASSERT_LT(nut->query().nearest(turn * vertex).distance, 0.02 * nut->diagonal());
  }
}

/// Prism about z over a polygon of `corners` points whose radii take turns.
Mesh prism(int corners, const std::vector<double>& radii, double height) {
  Mesh mesh;
  for (const double z : {-0.5 * height, 0.5 * height}) {
    for (int i = 0; i < corners; ++i) {
      const double angle = 2.0 * M_PI * i / corners, r = radii[static_cast<std::size_t>(i) % radii.size()];
      mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  mesh.vertices.push_back({0, 0, -0.5 * height});
  mesh.vertices.push_back({0, 0, 0.5 * height});
  const auto n = static_cast<std::uint32_t>(corners);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
    mesh.triangles.push_back({2 * n, j, i});
    mesh.triangles.push_back({2 * n + 1, i + n, j + n});
  }
  return mesh;
}

Mesh cone(int corners, double radius, double height) {
  Mesh mesh = prism(corners, {radius}, height);
  for (int i = 0; i < corners; ++i) mesh.vertices[static_cast<std::size_t>(corners + i)] *= 1e-3;
  for (int i = 0; i < corners; ++i) mesh.vertices[static_cast<std::size_t>(corners + i)].z() = 0.5 * height;
  return mesh;
}

/// As a file may have it: turned about an odd axis.
Mesh turned(Mesh mesh) {
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  for (Vec3& v : mesh.vertices) v = turn * v + Vec3(0.01, 0.02, -0.03);
  return mesh;
}

SymmetryReport of(const Mesh& mesh, double tolerance_m = 0.0) {
  const PartModelPtr part = PartModel::from_mesh(mesh, "part");
  return examine_symmetries(*part, tolerance_m > 0.0 ? tolerance_m / part->diagonal() : 0.01);
}

/// Poses that look alike, the identity among them.
std::size_t group(const SymmetryReport& report) {
  EXPECT_TRUE(report.symmetries.continuous.empty());
  EXPECT_EQ(report.discrete_error.size(), report.symmetries.discrete.size());
  for (const double error : report.discrete_error) EXPECT_LE(error, report.limit);
  return report.symmetries.discrete.size() + 1;
}

TEST(Symmetry, KnownAnswersHoldHoweverThePartLiesInItsFile) {
  for (const bool straight : {true, false}) {
    const auto placed = [&](const Mesh& mesh) { return straight ? mesh : turned(mesh); };
    EXPECT_EQ(group(of(placed(test::box_mesh({0.02, 0.02, 0.02})))), 24u) << "cube";
    EXPECT_EQ(group(of(placed(test::box_mesh({0.02, 0.03, 0.05})))), 4u) << "box";
    EXPECT_EQ(group(of(placed(prism(6, {0.01}, 0.008)))), 12u) << "hexagonal nut";
    for (const int teeth : {5, 12, 17, 24, 40}) {
      const Mesh gear = prism(4 * teeth, {0.05, 0.05, 0.043, 0.043}, 0.01);
      EXPECT_EQ(group(of(placed(gear), 2e-4)), 2u * static_cast<std::size_t>(teeth)) << teeth << " teeth, and over";
    }
    const SymmetryReport cylinder = of(placed(prism(128, {0.01}, 0.03)));
    EXPECT_EQ(cylinder.symmetries.continuous.size(), 1u);
    EXPECT_EQ(cylinder.symmetries.discrete.size(), 1u) << "over";
    EXPECT_EQ(of(placed(test::sphere_mesh(0.02, 4))).symmetries.continuous.size(), 2u) << "a ball";
    const SymmetryReport tip = of(placed(cone(128, 0.01, 0.03)));
    EXPECT_EQ(tip.symmetries.continuous.size(), 1u);
    EXPECT_TRUE(tip.symmetries.discrete.empty());
  }
}

/// Balls of odd tessellation: no vertex lies on an axis of the part, and no face stands across one.
Mesh balls(const std::vector<Vec3>& places) {
  Mesh mesh, ball = turned(test::sphere_mesh(0.006, 3));
  ball = test::moved(ball, -ball.bounds().center());
  for (const Vec3& place : places) test::append(mesh, test::moved(ball, place));
  return mesh;
}

TEST(Symmetry, RoundedArmsShowTheAxesOfPartsWhoseMomentsAreAllEqual) {
  const double c = 0.012;
  const std::vector<Vec3> tetrapod = {{c, c, c}, {c, -c, -c}, {-c, c, -c}, {-c, -c, c}};
  std::vector<Vec3> jack;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.02, 0.02}) jack.push_back(side * Vec3::Unit(axis));
  for (const bool straight : {true, false}) {
    const auto placed = [&](const Mesh& mesh) { return straight ? mesh : turned(mesh); };
    EXPECT_EQ(group(of(placed(balls(tetrapod)))), 12u);
    EXPECT_EQ(group(of(placed(balls(jack)))), 24u);
  }
}

TEST(Symmetry, AMarkBreaksItBelowItsSizeAndIsToldAsNearlySymmetric) {
  Mesh marked = prism(6, {0.01}, 0.008);
  test::append(marked, test::box_mesh({0.0005, 0.0005, 0.0005}, {0.006, 0.001, 0.00415}));  // 0.4 mm high
  const SymmetryReport fine = of(marked, 2e-4);
  EXPECT_EQ(group(fine), 1u);
  ASSERT_FALSE(fine.nearly.empty());
  const auto six =
      std::find_if(fine.nearly.begin(), fine.nearly.end(), [](const auto& axis) { return axis.order == 6; });
  ASSERT_NE(six, fine.nearly.end());
  EXPECT_NEAR(six->error, 4e-4, 5e-5);
  EXPECT_NEAR(std::abs(six->direction.z()), 1.0, 0.02);
  EXPECT_EQ(group(of(marked, 6e-4)), 12u);
}

TEST(Diameter, IsThatOfAllPairs) {
  const PartModelPtr part = sample("bracket_l");
  double longest = 0.0;
  for (const Vec3& a : part->mesh().vertices)
    for (const Vec3& b : part->mesh().vertices) longest = std::max(longest, (a - b).norm());
  EXPECT_DOUBLE_EQ(diameter(part->mesh()), longest);
}

}  // namespace
}  // namespace bin_scenes
