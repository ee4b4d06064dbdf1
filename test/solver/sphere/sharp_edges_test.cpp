#include "solver/sphere/shapes/sharp_edges.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace bin_scenes::sphere {
namespace {

constexpr double angle = 0.5;  // rad

/// A disk of radius 1 m and height 0.5 m around z.
Mesh disk(int sides) {
  Mesh mesh;
  for (const double z : {0.0, 0.5})
    for (int i = 0; i < sides; ++i) {
      const double turn = 2.0 * M_PI * i / sides;
      mesh.vertices.push_back(Vec3(std::cos(turn), std::sin(turn), z));
    }
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh.triangles.push_back({i, k, n + k});
    mesh.triangles.push_back({i, n + k, n + i});
    if (i == 0 || k == 0) continue;
    mesh.triangles.push_back({0, k, i});
    mesh.triangles.push_back({n, n + i, n + k});
  }
  return mesh;
}

SharpEdges edges_of(const Mesh& mesh) {
  return sharp_edges(mesh, folds_of(mesh, angle), angle);
}

double distance(const Mesh& mesh, const SharpEdge& edge, const Vec3& point) {
  const Vec3 &a = mesh.vertices[edge.a], along = mesh.vertices[edge.b] - a;
  const double at = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - a - at * along).norm();
}

TEST(StraightenedEdges, StayWithinTheirLimitOfASmoothOutline) {
  const Mesh mesh = disk(2000);
  const SharpEdges all = edges_of(mesh);
  ASSERT_EQ(all.convex.size(), 4000u);
  constexpr double most_off = 5e-4;
  const SharpEdges straight = straightened(mesh, all, most_off);
  // A chord is off a circle by its length^2 / 8: 0.0632 long it is off by the limit, and 100 go round.
  EXPECT_NEAR(static_cast<double>(straight.convex.size()), 2 * 100, 6);
  double worst = 0;
  for (const Vec3& vertex : mesh.vertices) {
    double nearest = 1;
    for (const SharpEdge& edge : straight.convex) nearest = std::min(nearest, distance(mesh, edge, vertex));
    worst = std::max(worst, nearest);
  }
  EXPECT_LE(worst, most_off);
  EXPECT_GT(worst, 0.9 * most_off);
}

TEST(StraightenedEdges, ArePressedBetweenTheirFaces) {
  const Mesh mesh = disk(2000);
  for (const SharpEdge& edge : straightened(mesh, edges_of(mesh), 5e-4).convex) {
    const Vec3 middle = 0.5 * (mesh.vertices[edge.a] + mesh.vertices[edge.b]);
    const double up = middle.z() > 0.25 ? 1.0 : -1.0;
    const Vec3 side = Vec3(middle.x(), middle.y(), 0).normalized();
    for (const Vec3& inside : {Vec3(0, 0, up), side, Vec3(side + up * Vec3::UnitZ()).normalized()}) {
      Vec3f direction = inside.cast<float>();
      ASSERT_TRUE(turn_into_cone(edge.cone, direction, LEAST_LEFT));
      EXPECT_LT((direction.cast<double>() - inside).norm(), 1e-4);
    }
    Vec3f below = Vec3f(0, 0, static_cast<float>(-up));
    EXPECT_FALSE(turn_into_cone(edge.cone, below, LEAST_LEFT) && below.dot(side.cast<float>()) < 0.99f);
  }
}

TEST(StraightenedEdges, AreThoseOfTheMeshWhereNoRunIsStraight) {
  for (const Mesh& mesh : {box_mesh(0.1), disk(24)}) {
    const SharpEdges all = edges_of(mesh), straight = straightened(mesh, all, 2e-4 * mesh.bounds().diagonal());
    ASSERT_EQ(straight.convex.size(), all.convex.size());
    for (std::size_t i = 0; i < all.convex.size(); ++i) {
      EXPECT_EQ(straight.convex[i].a, all.convex[i].a);
      EXPECT_EQ(straight.convex[i].b, all.convex[i].b);
      EXPECT_EQ(straight.convex[i].cone.bound, all.convex[i].cone.bound);
    }
  }
}

TEST(StraightenedEdges, EndAtCorners) {
  Mesh mesh = box_mesh(0.1);
  // Every triangle in four, three times: each edge of the box in eight pieces.
  for (int round = 0; round < 3; ++round) {
    Mesh finer;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    finer.vertices = mesh.vertices;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::minmax(a, b);
      const auto [it, added] = middles.insert({key, static_cast<std::uint32_t>(finer.vertices.size())});
      if (added) finer.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return it->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
        finer.triangles.push_back(t);
    }
    mesh = std::move(finer);
  }
  const SharpEdges all = edges_of(mesh), straight = straightened(mesh, all, 1e-6);
  EXPECT_EQ(all.convex.size(), 96u);
  ASSERT_EQ(straight.convex.size(), 12u);
  for (const SharpEdge& edge : straight.convex)
    EXPECT_NEAR((mesh.vertices[edge.a] - mesh.vertices[edge.b]).norm(), 0.1, 1e-12);
  EXPECT_NEAR(sharp_length(mesh, folds_of(mesh, angle), angle), 1.2, 1e-12);
}

}  // namespace
}  // namespace bin_scenes::sphere
