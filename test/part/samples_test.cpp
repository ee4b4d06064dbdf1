#include "bin_scenes/part/samples.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/features.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::test {
namespace {

SampleOptions aim(int count) {
  SampleOptions options;
  options.count = count;
  return options;
}

double nearest_sample(const SampleSet& set, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const SurfaceSample& s : set.samples) best = std::min(best, (s.point - p).norm());
  return best;
}

TEST(Features, BoxHasEightCornersAndTwelveEdges) {
  const Features features = sharp_features(box_mesh(Vec3(0.06, 0.04, 0.02)), 0.5);
  EXPECT_EQ(features.corners.size(), 8u);
  for (const FeatureCorner& corner : features.corners) {
    EXPECT_NEAR(corner.normal.dot(corner.point.cwiseSign()), std::sqrt(3.0), 1e-9);
  }
  ASSERT_EQ(features.curves.size(), 12u);
  double length = 0;
  for (const FeatureCurve& curve : features.curves) length += curve.length();
  EXPECT_NEAR(length, 4 * 0.12, 1e-12);
}

TEST(Features, RimOfACylinderIsOneClosedCurveWithoutCorners) {
  const Features features = sharp_features(prism_mesh(0.02, 0.03, 48), 0.5);
  EXPECT_TRUE(features.corners.empty());
  ASSERT_EQ(features.curves.size(), 2u);
  for (const FeatureCurve& curve : features.curves) {
    EXPECT_TRUE(curve.closed);
    EXPECT_NEAR(curve.length(), 48 * 2 * 0.02 * std::sin(M_PI / 48), 1e-12);
    for (const Vec3& n : curve.normals) EXPECT_NEAR(std::abs(n.z()), std::sqrt(0.5), 1e-9);
  }
}

TEST(Features, ConcaveEdgesAreNotSharp) {
  const Features features = sharp_features(l_mesh(1.0), 0.5);  // 18 edges, one of them concave, at (1, 1, z)
  double length = 0;
  for (const FeatureCurve& curve : features.curves) length += curve.length();
  EXPECT_NEAR(length, 2 * 8.0 + 5 * 1.0, 1e-9);
}

TEST(Features, SliversDoNotMakeEdges) {
  // A point just off the middle of the edge from vertex 4 to 5, joined by a sliver as T-junction repair does.
  Mesh mesh = box_mesh(Vec3::Ones());
  mesh.vertices.push_back(Vec3(0.1, -0.5, 0.5 + 1e-7));
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    if (t == Triangle{4, 5, 7}) {
      triangles.insert(triangles.end(), {{4, 8, 7}, {8, 5, 7}});
    } else {
      triangles.push_back(t);
    }
  }
  triangles.push_back({4, 5, 8});
  mesh.triangles = triangles;
  const Features features = sharp_features(mesh, 0.5);
  EXPECT_EQ(features.corners.size(), 8u);
  EXPECT_EQ(features.curves.size(), 12u);
}

TEST(Samples, LieOnTheSurfaceWithItsNormalAndMeetTheCount) {
  for (const Mesh& mesh :
       {box_mesh(Vec3(0.06, 0.04, 0.02)), torus_mesh(0.04, 0.012, 48, 20), prism_mesh(0.02, 0.05, 6)}) {
    const MeshQuery query(mesh);
    for (const int count : {16, 150, 1000}) {
      const SampleSet set = surface_samples(query, aim(count));
      EXPECT_EQ(set.samples.size(), static_cast<std::size_t>(count));
      for (const SurfaceSample& s : set.samples) {
        ASSERT_LT(query.nearest(s.point).distance, 1e-12);
        ASSERT_NEAR(s.normal.norm(), 1.0, 1e-9);
        ASSERT_FALSE(query.inside(s.point + 1e-6 * s.normal));
        ASSERT_TRUE(query.inside(s.point - 1e-6 * s.normal));
        ASSERT_GT(s.spacing, 0);
      }
    }
  }
}

TEST(Samples, EveryCornerOfABoxIsASample) {
  const Mesh mesh = box_mesh(Vec3(0.06, 0.04, 0.02));
  for (const int count : {16, 60, 500}) {
    const SampleSet set = surface_samples(mesh, aim(count));
    for (const Vec3& v : mesh.vertices) EXPECT_LT(nearest_sample(set, v), 1e-12) << count;
  }
}

TEST(Samples, EdgesAreSampledTwiceAsDenselyAsFaces) {
  const SampleSet set = surface_samples(box_mesh(Vec3::Constant(0.1)), aim(1000));
  double face = 0, edge = 0;
  for (const SurfaceSample& s : set.samples) {
    (s.normal.cwiseAbs().maxCoeff() > 0.99 ? face : edge) = s.spacing;
  }
  EXPECT_NEAR(edge / face, 0.5, 0.1);
}

// N discs of radius r can cover the area A only if N pi r^2 > A; farthest points get within 1.6 of that bound.
TEST(Samples, NoPointOfTheSurfaceIsFarFromASample) {
  for (const Mesh& mesh : {sphere_mesh(0.05, 4), torus_mesh(0.04, 0.012, 60, 24)}) {
    for (const int count : {100, 1000}) {
      const SampleSet set = surface_samples(mesh, aim(count));
      const double bound = 1.6 * std::sqrt(surface_area(mesh) / (M_PI * count));
      for (const Vec3& p : random_surface_points(mesh, 3000, 1)) ASSERT_LT(nearest_sample(set, p), bound);
    }
  }
}

TEST(Samples, BothSidesOfASheetAreCovered) {
  const Mesh mesh = box_mesh(Vec3(0.1, 0.1, 0.0005));
  SampleSet set = surface_samples(mesh, aim(600));
  int top = 0, bottom = 0;
  for (const SurfaceSample& s : set.samples) {
    top += s.normal.z() > 0.9;
    bottom += s.normal.z() < -0.9;
  }
  EXPECT_GT(std::min(top, bottom), 100);
  EXPECT_NEAR(top, bottom, 0.1 * top);
}

TEST(Samples, WhatNothingCanTouchGetsNone) {
  const Vec3 cavity = Vec3::Constant(0.08);
  const Mesh hollow = joined(box_mesh(Vec3::Constant(0.1)), inverted(box_mesh(cavity)));
  for (const SurfaceSample& s : surface_samples(hollow, aim(300)).samples) {
    ASSERT_NEAR(s.point.cwiseAbs().maxCoeff(), 0.05, 1e-12);
  }
  const Mesh crossed = joined(box_mesh(Vec3(0.1, 0.02, 0.02)), box_mesh(Vec3(0.02, 0.1, 0.021)));
  const MeshQuery query(crossed);
  for (const SurfaceSample& s : surface_samples(query, aim(300)).samples) {
    ASSERT_LT(query.winding(s.point + 1e-6 * s.normal), 0.5) << s.point.transpose();
  }
}

TEST(Samples, RunsAreCompact) {
  const Mesh mesh = sphere_mesh(0.05, 4);
  const SampleSet set = surface_samples(mesh, aim(1600));
  const double run_area = surface_area(mesh) * set.cluster / 1600;
  double sum = 0;
  int runs = 0;
  for (std::size_t begin = 0; begin < set.samples.size(); begin += set.cluster, ++runs) {
    Aabb box;
    for (std::size_t i = begin; i < std::min(begin + set.cluster, set.samples.size()); ++i) {
      box.extend(set.samples[i].point);
    }
    sum += box.diagonal();
  }
  EXPECT_LT(sum / runs, 2.0 * std::sqrt(run_area));  // a square patch has sqrt(2)
}

TEST(Samples, SameMeshGivesTheSameSamples) {
  const Mesh mesh = torus_mesh(0.04, 0.012, 48, 20);
  const SampleSet a = surface_samples(mesh, aim(500)), b = surface_samples(mesh, aim(500));
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) ASSERT_EQ(a.samples[i].point, b.samples[i].point);
}

TEST(Samples, NonsenseIsRefused) {
  EXPECT_THROW(surface_samples(Mesh{}, aim(100)), Error);
  EXPECT_THROW(surface_samples(box_mesh(Vec3::Ones()), aim(0)), Error);
}

}  // namespace
}  // namespace bin_scenes::test
