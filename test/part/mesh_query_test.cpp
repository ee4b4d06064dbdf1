#include "bin_scenes/part/mesh_query.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <set>

namespace bin_scenes {
namespace {

using namespace test;

Vec3 probe(Random& random, const Aabb& box, double grow) {
  Vec3 p;
  for (int i = 0; i < 3; ++i) {
    const double margin = grow * box.size()[i];
    p[i] = random.uniform(box.lower[i] - margin, box.upper[i] + margin);
  }
  return p;
}

/// Distance to one triangle by another road than Ericson's regions: the interior by the normal equations, the rim by
/// three segments.
double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto segment = [&](const Vec3& s, const Vec3& e) {
    const Vec3 d = e - s;
    const double length2 = d.squaredNorm();
    const double u = length2 > 0 ? std::clamp((p - s).dot(d) / length2, 0.0, 1.0) : 0.0;
    return (p - s - u * d).norm();
  };
  double best = std::min({segment(a, b), segment(b, c), segment(c, a)});
  const Vec3 n = (b - a).cross(c - a).normalized();
  const double height = (p - a).dot(n);
  const Vec3 foot = p - height * n;
  const bool within =
      n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 && n.dot((a - c).cross(foot - c)) >= 0;
  if (within) best = std::min(best, std::abs(height));
  return best;
}

double brute_distance(const Mesh& mesh, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    best = std::min(best, triangle_distance(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return best;
}

double brute_winding(const Mesh& mesh, const Vec3& p) {
  double angle = 0.0;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Vec3 a = (mesh.vertices[ia] - p).normalized(), b = (mesh.vertices[ib] - p).normalized(),
               c = (mesh.vertices[ic] - p).normalized();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return angle / (4.0 * M_PI);
}

/// Closed meshes: what one ray tells is what the solid angles of all triangles tell. Also where shells overlap or are
/// inside out, and from points whose ray goes through an edge or a corner.
TEST(MeshQuery, InsideAClosedMeshIsWhereItsWindingNumberIsAboveOneHalf) {
  Mesh two = box_mesh({0.02, 0.03, 0.04});
  append(two, box_mesh({0.03, 0.02, 0.01}, {0.005, 0.004, 0.003}));
  const Vec3 along(0.53812371, 0.31415927, 0.78214293);  // of the ray
  Random random(11, 0, Stream::probe);
  for (const Mesh& mesh : {two, inverted(two), torus_mesh(0.03, 0.01, 40, 20)}) {
    const MeshQuery query(mesh);
    std::size_t inside = 0;
    for (std::size_t k = 0; k < 20000; ++k) {
      Vec3 p = probe(random, mesh.bounds(), 0.2);
      const auto& [a, b, c] = mesh.triangles[k % mesh.triangles.size()];
      if (k % 10 == 1) p = mesh.vertices[a] - random.uniform(0.001, 0.05) * along;
      if (k % 10 == 2) p = 0.5 * (mesh.vertices[a] + mesh.vertices[b]) - random.uniform(0.001, 0.05) * along;
      const double winding = brute_winding(mesh, p);
      if (std::abs(winding - std::round(winding)) > 1e-6) continue;  // on the surface
      EXPECT_EQ(query.inside(p), winding > 0.5) << k << ": " << winding;
      inside += query.inside(p);
    }
    if (mesh.triangles != inverted(two).triangles) {
      EXPECT_GT(inside, 1000u);
    }
  }
}

TEST(MeshQuery, NearestPointOfABoxInClosedForm) {
  const MeshQuery query(box_mesh({2, 4, 6}));
  const auto distance = [&](double x, double y, double z) { return query.nearest({x, y, z}).distance; };
  EXPECT_DOUBLE_EQ(distance(0, 0, 0), 1.0);
  EXPECT_DOUBLE_EQ(distance(3, 0, 0), 2.0);
  EXPECT_NEAR(distance(2, 3, 0), std::sqrt(2.0), 1e-15);  // an edge
  EXPECT_NEAR(distance(2, 3, 4), std::sqrt(3.0), 1e-15);  // a corner
  EXPECT_LT((query.nearest({3, 0.5, -0.25}).point - Vec3(1, 0.5, -0.25)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(query.signed_distance({0.5, 0, 0}), -0.5);
  EXPECT_DOUBLE_EQ(query.signed_distance({1.5, 0, 0}), 0.5);
}

TEST(MeshQuery, NearestAgreesWithBruteForceOnRandomTriangles) {
  for (const std::size_t count : {1u, 3u, 5u, 40u, 700u}) {
    const Mesh mesh = random_soup(count, count);
    const MeshQuery query(mesh);
    Random random(7, count, Stream::probe);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = probe(random, mesh.bounds(), i % 2 ? 0.1 : 3.0);
      const double expected = brute_distance(mesh, p);
      const NearestPoint nearest = query.nearest(p);
      ASSERT_NEAR(nearest.distance, expected, 1e-12 * (1.0 + expected));
      ASSERT_NEAR((nearest.point - p).norm(), nearest.distance, 1e-15);
      const auto& [a, b, c] = mesh.triangles[nearest.triangle];
      ASSERT_NEAR(triangle_distance(nearest.point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]), 0.0, 1e-12);
    }
  }
}

TEST(MeshQuery, NearestGivesUpBeyondTheLimitAndOnlyThere) {
  const MeshQuery query(sphere_mesh(1.0, 3));
  const Vec3 p(0, 0, 3);
  const double distance = query.nearest(p).distance;
  EXPECT_TRUE(std::isinf(query.nearest(p, distance * (1 - 1e-9)).distance));
  EXPECT_EQ(query.nearest(p, distance * (1 + 1e-9)).distance, distance);
}

TEST(MeshQuery, DegenerateTrianglesAreFoundLikePointsAndSegments) {
  Mesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 5, 0)};
  mesh.triangles = {{0, 1, 2}, {3, 3, 3}};
  const MeshQuery query(mesh);
  EXPECT_NEAR(query.nearest({1.5, 1, 0}).distance, 1.0, 1e-15);
  EXPECT_NEAR(query.nearest({0, 6, 0}).distance, 1.0, 1e-15);
  EXPECT_NEAR(query.winding({1.5, 1, 0}), 0.0, 1e-15);
}

TEST(MeshQuery, CoincidentTrianglesDoNotExhaustTheTree) {
  Mesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles.assign(5000, {0, 1, 2});
  const MeshQuery query(mesh);
  EXPECT_DOUBLE_EQ(query.nearest({0.2, 0.2, 2}).distance, 2.0);
}

TEST(MeshQuery, WindingStaysCloseToTheSumOverAllTriangles) {
  for (const Mesh& mesh : {torus_mesh(1.0, 0.3, 64, 24), sphere_mesh(1.0, 4), random_soup(2000, 3), l_mesh(0.1)}) {
    const MeshQuery query(mesh);
    Random random(11, 0, Stream::probe);
    double squares = 0.0;
    const int probes = 1000;
    for (int i = 0; i < probes; ++i) {
      const Vec3 p = probe(random, mesh.bounds(), i % 2 ? 0.05 : 1.0);
      const double error = query.winding(p) - brute_winding(mesh, p);
      ASSERT_LT(std::abs(error), 3e-3);
      squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / probes), 3e-4);
  }
}

TEST(MeshQuery, InsideOfAConcaveShape) {
  const MeshQuery query(l_mesh(1.0));
  EXPECT_TRUE(query.inside({0.5, 1.5, 0.5}));
  EXPECT_TRUE(query.inside({1.5, 0.5, 0.5}));
  EXPECT_FALSE(query.inside({1.5, 1.5, 0.5}));  // in the notch: inside the hull, outside the part
  EXPECT_NEAR(query.signed_distance({1.1, 1.2, 0.5}), 0.1, 1e-12);
}

TEST(MeshQuery, InsideOfAHollowShape) {
  Mesh hollow = box_mesh({4, 4, 4});
  append(hollow, inverted(box_mesh({2, 2, 2})));
  const MeshQuery query(hollow);
  EXPECT_FALSE(query.inside({0, 0, 0}));
  EXPECT_TRUE(query.inside({1.5, 0, 0}));
  EXPECT_FALSE(query.inside({2.5, 0, 0}));
  EXPECT_NEAR(query.signed_distance({0, 0, 0}), 1.0, 1e-12);
}

TEST(MeshQuery, InsideOfOverlappingShellsAndThroughASmallHole) {
  Mesh two = box_mesh({2, 1, 1});
  append(two, box_mesh({1, 2, 1}));
  EXPECT_NEAR(MeshQuery(two).winding({0, 0, 0.1}), 2.0, 1e-9);
  EXPECT_TRUE(MeshQuery(two).inside({0.1, 0, 0}));
  EXPECT_TRUE(MeshQuery(two).inside({0.9, 0, 0}));
  EXPECT_FALSE(MeshQuery(two).inside({0.9, 0.9, 0}));

  Mesh open = sphere_mesh(1.0, 3);
  open.triangles.pop_back();
  EXPECT_TRUE(MeshQuery(open).inside({0, 0, 0}));
  EXPECT_FALSE(MeshQuery(open).inside({1.2, 0, 0}));
}

TEST(MeshQuery, OverlappingVisitsEachTriangleWhoseBoundsMeetTheBoxOnce) {
  const Mesh mesh = random_soup(500, 5);
  const MeshQuery query(mesh);
  Random random(3, 0, Stream::probe);
  for (int i = 0; i < 50; ++i) {
    Aabb box;
    box.extend(probe(random, mesh.bounds(), 0.0));
    box.extend(box.lower + Vec3::Constant(random.uniform(0.0, 0.3)));
    std::multiset<std::size_t> expected, visited;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Aabb bounds;
      for (const std::uint32_t v : mesh.triangles[t]) bounds.extend(mesh.vertices[v]);
      if (bounds.overlaps(box)) expected.insert(t);
    }
    query.overlapping(box, [&](std::size_t t) { visited.insert(t); });
    ASSERT_EQ(visited, expected);
  }
}

TEST(MeshQuery, AnEmptyMeshIsFarAndOutside) {
  const MeshQuery query{Mesh{}};
  EXPECT_TRUE(std::isinf(query.nearest({0, 0, 0}).distance));
  EXPECT_EQ(query.winding({0, 0, 0}), 0.0);
}

}  // namespace
}  // namespace bin_scenes
