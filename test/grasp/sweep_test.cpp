#include "grasp/sweep.hpp"

#include "grasp/pad.hpp"
#include "grasp/rays.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

/// What is left of a polygon inside a zonotope, by clipping at all of its faces: none, if they are apart.
bool meets_by_clipping(const Vec3& center, const std::vector<Vec3>& halves, std::vector<Vec3> polygon) {
  for (std::size_t i = 0; i < halves.size(); ++i) {
    for (std::size_t j = i + 1; j < halves.size(); ++j) {
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 normal = sign * halves[i].cross(halves[j]).normalized();
        if (!normal.allFinite()) continue;
        double reach = 0.0;
        for (const Vec3& half : halves) reach += std::abs(normal.dot(half));
        std::vector<Vec3> kept;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
          const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
          const double x = normal.dot(a - center) - reach, y = normal.dot(b - center) - reach;
          if (x <= 0) kept.push_back(a);
          if (x * y < 0) kept.push_back(a + x / (x - y) * (b - a));
        }
        polygon = kept;
      }
    }
  }
  return !polygon.empty();
}

TEST(Sweep, AgreesWithClippingOfTriangles) {
  Random random(5, 0, Stream::probe);
  const auto point = [&](double size) {
    return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const Pose pose{point(0.5), random.orientation()};
    const Vec3 half = point(1.0).cwiseAbs() + Vec3::Constant(0.05), displacement = point(1.0);
    std::vector<Vec3> halves;
    for (int k = 0; k < 3; ++k) halves.push_back(pose.orientation * (half[k] * Vec3::Unit(k)));
    Sweep sweep(pose, Vec3::Zero(), half);
    Vec3 center = pose.position;
    if (i % 2) {
      sweep = sweep.moved(displacement);
      halves.push_back(0.5 * displacement);
      center += 0.5 * displacement;
    }
    const Vec3 a = point(2.5), b = point(2.5), c = point(2.5);
    const bool expected = meets_by_clipping(center, halves, {a, b, c});
    met += expected;
    ASSERT_EQ(sweep.meets(a, b, c), expected) << i;
  }
  EXPECT_GT(met, 4000);
  EXPECT_LT(met, 16000);
}

TEST(Sweep, TreeFindsWhatAllTrianglesTell) {
  const Mesh mesh = test::torus_mesh(0.4, 0.1, 40, 20);
  const MeshQuery query(mesh);
  Random random(6, 0, Stream::probe);
  int met = 0;
  for (int i = 0; i < 1500; ++i) {
    const Pose pose{random.orientation() * Vec3(random.uniform(0.0, 0.7), 0, 0), random.orientation()};
    const Pose placed{random.orientation() * Vec3(0.1, 0, 0), random.orientation()};
    const Sweep sweep = Sweep::cylinder(pose, 0.04, -0.2, 0.0).moved(random.orientation() * Vec3(0.1, 0, 0));
    bool expected = false;
    for (const Triangle& t : mesh.triangles)
      expected = expected ||
                 sweep.meets(placed * mesh.vertices[t[0]], placed * mesh.vertices[t[1]], placed * mesh.vertices[t[2]]);
    met += expected;
    ASSERT_EQ(sweep.meets(query, placed), expected) << i;
  }
  EXPECT_GT(met, 300);
  EXPECT_LT(met, 1300);
}

TEST(Sweep, OctagonHoldsTheCircle) {
  const Sweep sweep = Sweep::cylinder(Pose(), 1.0, 0.0, 2.0);
  const auto touches = [&](const Vec3& at) {
    const Vec3 little = Vec3::Constant(1e-6);
    return sweep.meets(at, at + little, at + Vec3(1e-6, -1e-6, 0));
  };
  for (int i = 0; i < 32; ++i) {
    const Vec3 rim(std::cos(M_PI / 16 * i), std::sin(M_PI / 16 * i), 1.0);
    EXPECT_TRUE(touches(Vec3(0.999 * rim.x(), 0.999 * rim.y(), 1.0)));
    EXPECT_FALSE(touches(Vec3(1.09 * rim.x(), 1.09 * rim.y(), 1.0)));  // corners stand out by 8.2 %
  }
  EXPECT_FALSE(touches({0, 0, 2.001}));
  EXPECT_FALSE(touches({0, 0, -0.001}));
}

TEST(Passages, InAndOutOfARing) {
  const MeshQuery query(test::torus_mesh(0.4, 0.1, 200, 100));
  const auto found = passages(query, Vec3(-2.0, 1e-4, 1e-4), Vec3::UnitX(), 0.0);
  ASSERT_EQ(found.size(), 4u);
  const double expected[] = {1.5, 1.7, 2.3, 2.5};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[i].distance, expected[i], 1e-3);
}

TEST(DistanceIntegral, SquareAndTriangleFromAnyPoint) {
  const std::vector<Eigen::Vector2d> square = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  EXPECT_NEAR(distance_integral(square, {0, 0}), (std::sqrt(2.0) + std::asinh(1.0)) / 6.0, 1e-12);
  // From outside, against a sum over small squares.
  const Eigen::Vector2d from(0.7, -0.9);
  double sum = 0.0;
  constexpr int cells = 400;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      sum += (Eigen::Vector2d((i + 0.5) / cells - 0.5, (j + 0.5) / cells - 0.5) - from).norm() / (cells * cells);
  EXPECT_NEAR(distance_integral(square, from), sum, 1e-5);
}

}  // namespace
}  // namespace bin_scenes
