#include "bin_scenes/part/mass_properties.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

using namespace test;

void expect_near(const Mat3& actual, const Mat3& expected, double tolerance) {
  EXPECT_LE((actual - expected).cwiseAbs().maxCoeff(), tolerance) << actual << "\nexpected\n" << expected;
}

TEST(MassProperties, BoxInClosedForm) {
  const Vec3 size(0.3, 0.2, 0.1), center(1.0, -2.0, 3.0);
  const MassProperties mass = mass_properties(box_mesh(size, center));
  const double volume = size.prod();
  EXPECT_NEAR(mass.volume, volume, 1e-14);
  EXPECT_NEAR(mass.area, 2 * (0.06 + 0.03 + 0.02), 1e-14);
  EXPECT_LT((mass.center - center).norm(), 1e-13);
  const Vec3 squares = size.cwiseProduct(size);
  const Vec3 moments = volume / 12.0 * (Vec3::Constant(squares.sum()) - squares);
  expect_near(mass.inertia, moments.asDiagonal(), 1e-15);
  EXPECT_LT((mass.principal - moments).norm(), 1e-15);  // sides fall, so moments rise
}

TEST(MassProperties, CornerTetrahedronInClosedForm) {
  const double a = 1.0, b = 2.0, c = 3.0, volume = a * b * c / 6.0;
  const MassProperties mass = mass_properties(corner_tetrahedron(a, b, c));
  EXPECT_NEAR(mass.volume, volume, 1e-14);
  EXPECT_LT((mass.center - Vec3(a, b, c) / 4.0).norm(), 1e-14);
  // Integrals of x^2 and x y over it are V a^2 / 10 and V a b / 20, about the corner.
  const Vec3 sides(a, b, c);
  Mat3 second = volume / 20.0 * sides * sides.transpose();
  second.diagonal() *= 2.0;
  const Mat3 covariance = second - volume * mass.center * mass.center.transpose();
  expect_near(mass.inertia, covariance.trace() * Mat3::Identity() - covariance, 1e-14);
}

TEST(MassProperties, SphereConvergesWithTheSquareOfTheEdge) {
  const double radius = 0.5, volume = 4.0 / 3.0 * M_PI * std::pow(radius, 3);
  double previous = 0.0;
  for (const int levels : {3, 4, 5}) {
    const MassProperties mass = mass_properties(sphere_mesh(radius, levels));
    const double error = 1.0 - mass.volume / volume;
    EXPECT_GT(error, 0.0);
    if (previous > 0.0) {
      EXPECT_NEAR(previous / error, 4.0, 0.15);
    }
    previous = error;
    EXPECT_NEAR(mass.inertia(0, 0) / (0.4 * mass.volume * radius * radius), 1.0, 2.0 * error);
    EXPECT_LT(mass.center.norm(), 1e-15);
  }
  EXPECT_LT(previous, 2e-3);
}

TEST(MassProperties, TorusInClosedForm) {
  const double ring = 2.0, tube = 0.5;
  const MassProperties mass = mass_properties(torus_mesh(ring, tube, 400, 200));
  const double volume = 2.0 * M_PI * M_PI * ring * tube * tube;
  EXPECT_NEAR(mass.volume / volume, 1.0, 4e-4);
  EXPECT_NEAR(mass.inertia(2, 2) / (volume * (ring * ring + 0.75 * tube * tube)), 1.0, 8e-4);
  EXPECT_NEAR(mass.inertia(0, 0) / (volume * (0.5 * ring * ring + 0.625 * tube * tube)), 1.0, 8e-4);
}

TEST(MassProperties, HollowBoxIsTheDifferenceOfTwo) {
  Mesh hollow = box_mesh({4, 4, 2});
  append(hollow, inverted(box_mesh({2, 2, 1}, {0.5, 0, 0})));
  const MassProperties mass = mass_properties(hollow);
  EXPECT_NEAR(mass.volume, 32.0 - 4.0, 1e-12);
  EXPECT_LT((mass.center - Vec3(-2.0 / 28.0, 0, 0)).norm(), 1e-13);
  const double outer = 32.0 / 12.0 * (16 + 16), inner = 4.0 / 12.0 * (4 + 4) + 4.0 * 0.25;
  EXPECT_NEAR(mass.inertia(2, 2), outer - inner - 28.0 * std::pow(2.0 / 28.0, 2), 1e-11);
}

TEST(MassProperties, MoveWithThePartAndNotWithTheOrigin) {
  Mesh mesh = l_mesh(0.4);
  const MassProperties still = mass_properties(mesh);
  EXPECT_NEAR(still.volume, 1.2, 1e-14);
  const Pose pose{Vec3(10, -20, 30), Quat(Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()))};
  const MassProperties moved = mass_properties(transformed(mesh, pose));
  EXPECT_NEAR(moved.volume, still.volume, 1e-12);
  EXPECT_LT((moved.center - pose * still.center).norm(), 1e-12);
  const Mat3 r = pose.orientation.toRotationMatrix();
  expect_near(moved.inertia, r * still.inertia * r.transpose(), 1e-12);
  EXPECT_LT((moved.principal - still.principal).norm(), 1e-12);
}

TEST(MassProperties, PrincipalAxesAreARotationThatMakesTheInertiaDiagonal) {
  const Pose pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.7, Vec3(3, -1, 2).normalized()))};
  const MassProperties mass = mass_properties(transformed(box_mesh({3, 2, 1}), pose));
  const Mat3 axes = mass.principal_axes.toRotationMatrix();
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-14);
  expect_near(axes * mass.principal.asDiagonal() * axes.transpose(), mass.inertia, 1e-13);
  EXPECT_LT(mass.principal[0], mass.principal[1]);
  EXPECT_LT(mass.principal[1], mass.principal[2]);
}

TEST(MassProperties, InsideOutIsNegative) {
  EXPECT_NEAR(mass_properties(inverted(box_mesh({1, 1, 1}))).volume, -1.0, 1e-15);
}

}  // namespace
}  // namespace bin_scenes
