/// Depths of contacts (pass note_depths) against overlaps that are known.
#include "bin_scenes/core/random.hpp"
#include "boxes.hpp"
#include "solver/sphere/make_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {
namespace {

/// Returns the depth (m) that the first step of two bodies at rest notes. The second one is at x and q.
float noted(World& world, const Vec3f& x, const Quatf& q = Quatf::Identity()) {
  world.gravity.setZero();
  world.bodies[1].x = x;
  world.bodies[1].q = q;
  for (Body& b : world.bodies) b.rotation = b.q.toRotationMatrix();
  world.manifolds.clear();
  world.deepest = {};
  find_pairs(world);
  find_contacts(world);
  color_manifolds(world);
  note_depths(world);
  return world.deepest.depth;
}

TEST(NoteDepths, OfBoxesSideBySideIsTheirOverlap) {
  for (const double edge : {0.005, 0.05, 0.3})
    for (const double height : {1.0, 0.3}) {
      PartModelPtr part;
      const Shape shape = box_shape(part, edge * Vec3(1, 1, height), 0.006);
      for (const double share : {0.01, 0.03, 0.08})
        for (const double along : {0.0, 0.21}) {
          World world = world_of_boxes(shape, 2);
          world.fine = true;
          const float depth = noted(world, (edge * Vec3(1 - share, along, 0)).cast<float>());
          EXPECT_LE(depth, 1.001 * share * edge + 0.5 * shape.field.cell) << edge << " " << height << " " << share;
          EXPECT_GE(depth, 0.8 * share * edge) << edge << " " << height << " " << share << " " << along;
        }
    }
}

TEST(NoteDepths, OfACornerInAFaceIsHowFarItIsIn) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3::Constant(0.06), 0.005);
  World world = world_of_boxes(shape, 2);
  world.fine = true;
  const Quatf on_corner = Quatf::FromTwoVectors(Vec3f(1, 1, 1).normalized(), -Vec3f::UnitZ());
  for (const float depth : {0.0005f, 0.002f, 0.006f})
    EXPECT_NEAR(noted(world, Vec3f(0, 0, 0.03f + 0.03f * std::sqrt(3.0f) - depth), on_corner), depth, 1e-5f);
}

TEST(NoteDepths, OfCrossedEdgesIsAtLeastHowFarOnePointIsIn) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.2, 0.02, 0.02}, 0.004);
  const float depth = 0.001f;
  World world = crossed_bars(shape, depth);
  const float found = noted(world, world.bodies[1].x, world.bodies[1].q);
  EXPECT_LE(found, depth + 1e-6f);
  EXPECT_GE(found, depth / std::sqrt(2.0f) - 0.1f * shape.field.cell) << "from an edge to the nearest face";
}

// Along their normals, contacts of teeth that overlap by 2 % of d were up to 7 % of d deep, and four of sixteen heaps
// of gears were set apart for it.
TEST(NoteDepths, OfGearsAreNotAboveThatOfTheirDeepestPoint) {
  const PartModelPtr gear = sample_part("gear_spur.stl");
  if (!gear) GTEST_SKIP() << "BIN_SCENES_MODELS is not set";
  const Shape shape = make_shape(*gear, 100, 400, 0.02);
  World world = world_of_boxes(shape, 2);
  Random random(7, 0, Stream::probe);
  std::vector<Vec3f> surface;
  for (const auto& t : gear->mesh().triangles) {
    const auto corner = [&](int k) -> Vec3f { return gear->mesh().vertices[t[k]].cast<float>() - shape.center; };
    for (int i = 0; i < 3; ++i)
      for (int k = 0; i + k < 3; ++k)
        surface.push_back(corner(0) + (0.5f * i) * (corner(1) - corner(0)) + (0.5f * k) * (corner(2) - corner(0)));
  }
  int deep = 0;
  for (int i = 0; i < 100; ++i) {
    const Quatf q = random.orientation().cast<float>();
    const Vec3f way = (random.orientation() * Vec3::UnitX()).cast<float>();
    float deepest_point = 0;
    Vec3f x;
    const auto deepest_at = [&](float distance) {
      x = distance * way;
      float depth = 0;
      for (const Vec3f& p : surface) {
        depth = std::max(depth, -shape.field.sample(x + q * p));
        depth = std::max(depth, -shape.field.sample(q.conjugate() * (p - x)));
      }
      return depth;
    };
    float distance = shape.diagonal;
    while (distance > 0 && (deepest_point = deepest_at(distance)) < 0.015f * shape.diagonal)
      distance -= 0.01f * shape.diagonal;
    const float depth = noted(world, x, q);
    EXPECT_LE(depth, deepest_point + shape.field.cell) << i;
    deep += depth > 0.5f * deepest_point;
  }
  EXPECT_GT(deep, 75) << "poses whose overlap is noted";
}

}  // namespace
}  // namespace bin_scenes::sphere
