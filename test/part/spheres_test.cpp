#include "bin_scenes/part/spheres.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::test {
namespace {

VoxelOptions with_voxels(int voxels, double tightness = 1.0) {
  VoxelOptions options;
  options.voxels = voxels;
  options.tightness = tightness;
  return options;
}

TEST(Spheres, CubeKeepsItsShellOfVoxels) {
  for (const int n : {1, 2, 3, 5, 8}) {
    const SphereSet set = voxel_spheres(box_mesh(Vec3::Constant(0.05), Vec3(0.3, 0, 0)), with_voxels(n));
    const int inner = std::max(0, n - 2);
    EXPECT_EQ(set.spheres.size(), static_cast<std::size_t>(n * n * n - inner * inner * inner)) << n;
    EXPECT_EQ(set.interior_removed, static_cast<std::size_t>(inner * inner * inner)) << n;
    EXPECT_NEAR(set.pitch, 0.05 / n, 1e-12);
    for (const Sphere& s : set.spheres) EXPECT_NEAR(s.radius, 0.025 / n, 1e-12);
  }
  VoxelOptions all = with_voxels(5);
  all.keep_interior = true;
  EXPECT_EQ(voxel_spheres(box_mesh(Vec3::Constant(0.05)), all).spheres.size(), 125u);
}

TEST(Spheres, OnlyFaceSpheresOfACubeHaveANormalAndItIsTheFaces) {
  const SphereSet set = voxel_spheres(box_mesh(Vec3::Constant(0.05)), with_voxels(5));
  std::size_t faces = 0;
  for (const Sphere& s : set.spheres) {
    const Vec3 out = (s.center / (0.02 - 1e-9)).unaryExpr([](double x) {
      return std::trunc(x);
    });  // +-1 an axis whose face the sphere touches
    if (out.cwiseAbs().sum() == 1) {
      ++faces;
      EXPECT_LT((s.normal - out).norm(), 1e-9);
    } else {
      EXPECT_TRUE(s.normal.isZero());
    }
  }
  EXPECT_EQ(faces, 6u * 9u);
}

TEST(Spheres, TighterVoxelsOverlapAndStillTouchTheBoundingBoxFromInside) {
  const SphereSet set = voxel_spheres(box_mesh(Vec3::Constant(0.05)), with_voxels(5, 0.5));
  EXPECT_EQ(set.spheres.size(), 125u - 27u);
  EXPECT_NEAR(set.pitch, set.spheres[0].radius, 1e-12);
  double reach = 0;
  for (const Sphere& s : set.spheres) reach = std::max(reach, s.center.cwiseAbs().maxCoeff() + s.radius);
  EXPECT_NEAR(reach, 0.025, 1e-12);
}

TEST(Spheres, CavityStaysEmpty) {
  const Mesh mesh = joined(box_mesh(Vec3::Constant(0.1)), inverted(box_mesh(Vec3::Constant(0.06))));
  const SphereSet set = voxel_spheres(mesh, with_voxels(10));
  for (const Sphere& s : set.spheres) EXPECT_GT(s.center.cwiseAbs().maxCoeff(), 0.03);
}

TEST(Spheres, SheetThinnerThanAVoxelIsCovered) {
  // A cross of two sheets of 0.4 mm, off every voxel centre.
  Mesh mesh = joined(box_mesh(Vec3(0.1, 0.1, 0.0004), Vec3(0, 0, 0.0031)), box_mesh(Vec3(0.1, 0.0004, 0.04)));
  const SphereSet set = voxel_spheres(mesh, with_voxels(12));
  for (const Vec3& p : random_surface_points(mesh, 3000, 3)) {
    double nearest = 1;
    for (const Sphere& s : set.spheres) nearest = std::min(nearest, (s.center - p).norm());
    ASSERT_LT(nearest, 1.01 * std::sqrt(3.0) * set.pitch);
  }
}

TEST(Spheres, SeveralRadiiFillTheInsideWithLargeOnes) {
  const Mesh mesh = box_mesh(Vec3::Constant(0.06));
  const MeshQuery query(mesh);
  VoxelOptions options;
  options.radii = {0.01, 0.003};
  const SphereSet set = voxel_spheres(query, options);
  std::size_t large = 0;
  for (const Sphere& s : set.spheres) {
    large += s.radius > 0.005;
    EXPECT_LE(query.signed_distance(s.center), -s.radius * (1 - 1e-5));
  }
  EXPECT_EQ(large, 27u);
  EXPECT_GT(set.spheres.size(), 27u);
  for (const Sphere& s : set.spheres) {  // none is hidden in a larger one
    for (std::size_t i = 0; i < large; ++i) {
      const Sphere& big = set.spheres[i];
      if (&big != &s) {
        EXPECT_GT((big.center - s.center).norm() + s.radius, big.radius);
      }
    }
  }
}

TEST(Spheres, ManyVoxelsPassTheThesissLimit) {
  EXPECT_GT(voxel_spheres(sphere_mesh(0.05, 3), with_voxels(48)).spheres.size(), 4096u);
}

TEST(Spheres, NonsenseIsRefused) {
  EXPECT_THROW(voxel_spheres(Mesh{}, with_voxels(5)), Error);
  EXPECT_THROW(voxel_spheres(box_mesh(Vec3::Ones()), with_voxels(0)), Error);
  EXPECT_THROW(voxel_spheres(box_mesh(Vec3::Ones()), with_voxels(5, 0.0)), Error);
  VoxelOptions rising;
  rising.radii = {0.1, 0.2};
  EXPECT_THROW(voxel_spheres(box_mesh(Vec3::Ones()), rising), Error);
}

}  // namespace
}  // namespace bin_scenes::test
