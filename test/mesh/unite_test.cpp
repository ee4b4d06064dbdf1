#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "mesh_repair.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::test {
namespace {

/// What a box adds to the moments of a union: volume, volume times centre, and second moments about the origin.
struct Moments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();

  void add(double sign, const Vec3& size, const Vec3& center) {
    const double v = sign * size.prod();
    volume += v;
    first += v * center;
    second += v * (center * center.transpose() + Mat3(size.cwiseAbs2().asDiagonal()) / 12.0);
  }
  Vec3 center() const { return first / volume; }
  Mat3 inertia() const {
    const Mat3 central = second - volume * center() * center().transpose();
    return central.trace() * Mat3::Identity() - central;
  }
};

void expect_union(const Mesh& united, const Moments& exact) {
  EXPECT_EQ(repair::open_edges(united), 0u);
  const MassProperties mass = mass_properties(united);
  EXPECT_NEAR(mass.volume, exact.volume, 1e-6 * exact.volume);
  EXPECT_LT((mass.center - exact.center()).norm(), 1e-6);
  EXPECT_LT((mass.inertia - exact.inertia()).norm(), 1e-5 * exact.inertia().norm());
}

TEST(Unite, TwoBoxesCountWhatTheyShareOnce) {
  Mesh mesh = joined(box_mesh(Vec3(2, 2, 2)), box_mesh(Vec3(2, 2, 2), Vec3(1, 0.5, 0.25)));
  ASSERT_TRUE(repair::unite(mesh, 1e-6));
  Moments exact;
  exact.add(1, Vec3(2, 2, 2), Vec3::Zero());
  exact.add(1, Vec3(2, 2, 2), Vec3(1, 0.5, 0.25));
  exact.add(-1, Vec3(1, 1.5, 1.75), Vec3(0.5, 0.25, 0.125));
  expect_union(mesh, exact);
  EXPECT_EQ(repair::shells(mesh).count, 1u);
}

TEST(Unite, FacesInOnePlaneAreThereOnce) {
  Mesh mesh = joined(box_mesh(Vec3(4, 1, 1)), box_mesh(Vec3(1, 4, 1), Vec3(0.2, 0, 0)));
  ASSERT_TRUE(repair::unite(mesh, 1e-6));
  Moments exact;
  exact.add(1, Vec3(4, 1, 1), Vec3::Zero());
  exact.add(1, Vec3(1, 4, 1), Vec3(0.2, 0, 0));
  exact.add(-1, Vec3(1, 1, 1), Vec3(0.2, 0, 0));
  expect_union(mesh, exact);
  EXPECT_NEAR(mass_properties(mesh).area, 2 * 7 + 16.0, 1e-6);
}

TEST(Unite, WhatLiesInsideAnotherSolidGoesAndCavitiesStay) {
  const Mesh hollow = joined(box_mesh(Vec3::Constant(3)), inverted(box_mesh(Vec3::Constant(2))));
  Mesh inside = joined(box_mesh(Vec3::Constant(3)), box_mesh(Vec3::Constant(1)));
  ASSERT_TRUE(repair::unite(inside, 1e-6));
  EXPECT_EQ(inside.triangles.size(), 12u);
  // A rod through the hollow box: outside it, in both walls and across the cavity.
  Mesh rod = joined(hollow, box_mesh(Vec3(5, 0.5, 0.5)));
  ASSERT_TRUE(repair::unite(rod, 1e-6));
  Moments exact;
  exact.add(1, Vec3::Constant(3), Vec3::Zero());
  exact.add(-1, Vec3::Constant(2), Vec3::Zero());
  exact.add(1, Vec3(5, 0.5, 0.5), Vec3::Zero());
  exact.add(-1, Vec3(0.5, 0.5, 0.5), Vec3(1.25, 0, 0));
  exact.add(-1, Vec3(0.5, 0.5, 0.5), Vec3(-1.25, 0, 0));
  expect_union(rod, exact);
}

// Each of 12,000 triangles lies in the boxes of up to 999 other shells: the largest one answers for all.
TEST(Unite, OfAThousandNestedBoxesTheLargestRemains) {
  Mesh mesh;
  for (int i = 0; i < 1000; ++i) mesh = joined(mesh, box_mesh(Vec3::Constant(1 + 1e-3 * i)));
  ASSERT_TRUE(repair::unite(mesh, 1e-6));
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(mass_properties(mesh).volume, std::pow(1.999, 3), 1e-6);
}

TEST(Unite, TurnedBoxesClose) {
  const Quat turn = Quat(0.8, 0.3, -0.4, 0.33).normalized();
  Mesh other = box_mesh(Vec3(3, 0.5, 0.7));
  for (Vec3& v : other.vertices) v = turn * v;
  Mesh mesh = joined(box_mesh(Vec3(2, 1.5, 1)), other);
  const double apart = mass_properties(mesh).volume;
  ASSERT_TRUE(repair::unite(mesh, 1e-6));
  EXPECT_EQ(repair::open_edges(mesh), 0u);
  // Against counting: points of a fine grid in both boxes.
  const int n = 120;
  int both = 0;
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 p = Vec3(2, 1.5, 1).cwiseProduct(Vec3(i % n, i / n % n, i / n / n) / n + Vec3::Constant(0.5 / n - 0.5));
    both += box_distance(Vec3(1.5, 0.25, 0.35), turn.inverse() * p) < 0;
  }
  const double shared = 3.0 * both / (n * n * n);
  EXPECT_NEAR(mass_properties(mesh).volume, apart - shared, 2e-3);
}

// The wall of one box deep inside the other is no surface: the field must not come near zero there.
TEST(Unite, BuriedWallsAreNoSurface) {
  const LoadedMesh loaded = repair_mesh(
      joined(box_mesh(Vec3(0.06, 0.02, 0.02)), box_mesh(Vec3(0.06, 0.02, 0.02), Vec3(0.04, 0, 0.001))), {}, "part");
  const auto& flags = loaded.report.flags;
  EXPECT_TRUE(std::any_of(flags.begin(), flags.end(), [](const Flag& f) { return f.code == "shells_united"; }));
  const DistanceField field = distance_field(loaded.mesh, {0.01});
  EXPECT_NEAR(field.distance(Vec3(0.03, 0, 0.0005)), -0.01, 1e-3);  // at the end of the first box
}

}  // namespace
}  // namespace bin_scenes::test
