#include "bin_scenes/part/wall_thickness.hpp"

#include "bin_scenes/part/mesh_query.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::test {
namespace {

double thickness(const Mesh& mesh) {
  return wall_thickness(MeshQuery(mesh));
}

/// A rectangle in the plane of x and z turned about z, with that many sides.
Mesh tube_mesh(double inner, double outer, double height, int sides) {
  Mesh mesh;
  const auto index = [&](int i, int k) { return static_cast<std::uint32_t>(4 * (i % sides) + k % 4); };
  for (int i = 0; i < sides; ++i) {
    const double u = 2.0 * M_PI * i / sides;
    for (const auto& [r, z] : {std::pair{outer, 0.0}, {outer, height}, {inner, height}, {inner, 0.0}})
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), z});
    for (int k = 0; k < 4; ++k) {
      mesh.triangles.push_back({index(i, k), index(i + 1, k), index(i + 1, k + 1)});
      mesh.triangles.push_back({index(i, k), index(i + 1, k + 1), index(i, k + 1)});
    }
  }
  return mesh;
}

Mesh cone_mesh(double radius, double height, int sides) {
  Mesh mesh;
  mesh.vertices = {Vec3::Zero(), Vec3(0, 0, height)};
  for (int i = 0; i < sides; ++i) {
    const double u = 2.0 * M_PI * i / sides;
    mesh.vertices.push_back({radius * std::cos(u), radius * std::sin(u), 0});
    const auto a = static_cast<std::uint32_t>(2 + i), b = static_cast<std::uint32_t>(2 + (i + 1) % sides);
    mesh.triangles.push_back({0, b, a});
    mesh.triangles.push_back({1, a, b});
  }
  return mesh;
}

TEST(WallThickness, OfBoxesIsTheirLeastEdge) {
  for (const Vec3& size : {Vec3(0.06, 0.04, 0.02), Vec3(0.05, 0.05, 0.05), Vec3(0.1, 0.08, 0.002),
                           Vec3(0.05, 0.04, 2e-4), Vec3(0.004, 0.09, 0.004), Vec3(3e-4, 5e-4, 2e-4)})
    EXPECT_NEAR(thickness(box_mesh(size, Vec3(0.3, 0.2, 0.1))) / size.minCoeff(), 1.0, 1e-9) << size.transpose();
}

TEST(WallThickness, OfARodIsItsDiameterAndOfATubeItsWall) {
  const double facet = std::cos(M_PI / 48);
  EXPECT_NEAR(thickness(prism_mesh(0.003, 0.08, 48)), 0.006 * facet, 1e-9);
  EXPECT_NEAR(thickness(tube_mesh(0.010, 0.0115, 0.05, 48)), 0.0015 * facet, 1e-9);
  EXPECT_NEAR(thickness(tube_mesh(0.010, 0.020, 0.001, 48)), 0.001, 1e-9);  // a washer
}

TEST(WallThickness, OfARingIsItsTubesDiameter) {
  const double found = thickness(torus_mesh(0.04, 0.005, 96, 48));
  EXPECT_LE(found, 0.010);
  EXPECT_GT(found, 0.95 * 0.010);
}

TEST(WallThickness, OfABracketIsThatOfItsArms) {
  EXPECT_NEAR(thickness(l_mesh(5.0)), 1.0, 1e-9);
  EXPECT_NEAR(thickness(l_mesh(0.3)), 0.3, 1e-9);
}

// With a half the tip's angle, it is s tan(2 a) across the tip, at s from there; above the base and behind the cone's
// rim, at e from the rim, it is e / tan(a). One twentieth of the surface has less.
TEST(WallThickness, OfAConeIsLessAtATwentiethOfItNearTipAndRim) {
  const double radius = 0.01, height = 0.03, slant = std::hypot(radius, height), half = std::atan(radius / height);
  const double found = thickness(cone_mesh(radius, height, 128));
  const double tip = found / std::tan(2.0 * half), rim = found * std::tan(half);
  ASSERT_LT(tip / std::cos(2.0 * half), slant);
  const double base = radius * radius - std::pow(radius - rim, 2);
  const double side = radius / slant * (tip * tip + slant * slant - std::pow(slant - rim, 2));
  const double thinner = M_PI * (base + side);
  EXPECT_NEAR(thinner / (M_PI * radius * (slant + radius)), 0.05, 0.003);
}

// A fin of a tenth of the surface counts, one of a hundredth does not.
TEST(WallThickness, IsOfWhatMakesUpATwentiethOfTheSurface) {
  const Mesh block = box_mesh(Vec3(0.05, 0.05, 0.05));  // 15,000 mm2
  EXPECT_NEAR(thickness(joined(block, box_mesh(Vec3(0.0301, 0.03, 0.001), Vec3(0.04, 0, 0)))), 0.001, 1e-6);
  EXPECT_NEAR(thickness(joined(block, box_mesh(Vec3(0.0301, 0.003, 0.001), Vec3(0.04, 0, 0)))), 0.05, 1e-6);
}

TEST(WallThickness, OfSolidsThatOverlapIsThatOfWhatTheyMake) {
  const Mesh one = box_mesh(Vec3(0.05, 0.05, 0.010)), other = box_mesh(Vec3(0.05, 0.05, 0.010), Vec3(0, 0, 0.004));
  EXPECT_NEAR(thickness(joined(one, other)), 0.014, 1e-6);
  const Mesh hollow = joined(sphere_mesh(0.02, 5), inverted(sphere_mesh(0.019, 5)));
  EXPECT_NEAR(thickness(hollow), 0.001, 2e-5);
}

TEST(WallThickness, IsNoneWithoutAnInside) {
  EXPECT_EQ(thickness({}), 0.0);
  EXPECT_EQ(thickness(random_soup(100, 1)), 0.0);
  EXPECT_EQ(thickness(inverted(box_mesh(Vec3(0.06, 0.04, 0.02)))), 0.0);
  Mesh open = box_mesh(Vec3(0.06, 0.04, 0.02));
  open.triangles.pop_back();
  EXPECT_EQ(thickness(open), 0.0);
}

}  // namespace
}  // namespace bin_scenes::test
