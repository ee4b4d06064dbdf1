#include "plane_cuts.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::test {
namespace {

TEST(Clip, AreasOfBothSidesAddUpAndStayOnTheirSide) {
  const Mesh torus = torus_mesh(0.04, 0.012, 32, 16);
  const CutPlane plane{Vec3(1, 2, -0.5).normalized(), 0.011};
  const auto [below, above] = clip(torus, plane, 1e-9);
  EXPECT_NEAR(surface_area(below) + surface_area(above), surface_area(torus), 1e-12);
  EXPECT_GT(surface_area(below), 0.2 * surface_area(torus));
  EXPECT_GT(surface_area(above), 0.2 * surface_area(torus));
  for (const Vec3& v : below.vertices) EXPECT_LE(plane.height(v), 1e-9);
  for (const Vec3& v : above.vertices) EXPECT_GE(plane.height(v), -1e-9);
}

TEST(Clip, FaceInThePlaneStaysWithItsSolid) {
  const auto [below, above] = clip(box_mesh(Vec3::Constant(2.0)), {Vec3::UnitZ(), 1.0}, 1e-9);
  EXPECT_NEAR(surface_area(below), 24.0, 1e-12);
  EXPECT_TRUE(above.empty());
}

TEST(Clip, KeepsTheWindingOfTriangles) {
  const auto [below, above] = clip(box_mesh(Vec3::Constant(2.0)), {Vec3::UnitZ(), 0.25}, 1e-9);
  for (const Mesh* side : {&below, &above}) {
    for (std::size_t t = 0; t < side->triangles.size(); ++t) {
      EXPECT_GT(side->area_vector(t).dot(side->vertices[side->triangles[t][0]]), 0.0);  // away from the middle
    }
  }
}

/// A cross of two bars, measured by its closed form.
TEST(PlaneCuts, CrossIsAFewBoxesThatShareNothing) {
  const Mesh cross = [] {
    const double xs[] = {3, 3, 1, 1, -1, -1, -3, -3, -1, -1, 1, 1}, ys[] = {-1, 1, 1, 3, 3, 1, 1, -1, -1, -3, -3, -1};
    Mesh mesh;
    for (const double z : {0.0, 1.0}) {
      for (int i = 0; i < 12; ++i) mesh.vertices.push_back({xs[i], ys[i], z});
    }
    for (std::uint32_t i = 0; i < 12; ++i) {
      const std::uint32_t j = (i + 1) % 12;
      mesh.triangles.push_back({i, j, j + 12});
      mesh.triangles.push_back({i, j + 12, i + 12});
    }
    for (const auto& [a, b, c] :
         {Triangle{0, 1, 2}, Triangle{0, 2, 11}, Triangle{3, 4, 5}, Triangle{3, 5, 2}, Triangle{6, 7, 8},
          Triangle{6, 8, 5}, Triangle{9, 10, 11}, Triangle{9, 11, 8}, Triangle{2, 5, 8}, Triangle{2, 8, 11}}) {
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a + 12, b + 12, c + 12});
    }
    return mesh;
  }();
  ASSERT_NEAR(mass_properties(cross).volume, 20.0, 1e-12);
  const auto distance = [](const Vec3& p) {
    const Vec3 q = p - Vec3(0, 0, 0.5);
    return std::min(box_distance(Vec3(3, 1, 0.5), q), box_distance(Vec3(1, 3, 0.5), q));
  };
  const auto protrusion = [&](const Mesh& hull) {
    std::pair<double, Vec3> worst{0.0, hull.vertices[0]};
    for (const Vec3& p : random_surface_points(hull, 500, 1)) {
      if (distance(p) > worst.first) worst = {distance(p), p};
    }
    return worst;
  };
  const auto pieces = plane_cut_pieces(cross, {protrusion, [&](const Vec3& p) { return distance(p) < 0; }}, 0.01, 20);
  EXPECT_LE(pieces.size(), 5u);
  double sum = 0;
  for (const auto& points : pieces) {
    const Mesh hull = convex_hull(points, 100);
    EXPECT_LT(protrusion(hull).first, 1e-9);
    sum += mass_properties(hull).volume;
  }
  EXPECT_NEAR(sum, 20.0, 1e-9);
}

}  // namespace
}  // namespace bin_scenes::test
