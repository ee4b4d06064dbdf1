/// Contacts near sharp edges, where the grid of a distance field is rounded.
#include "solver/sphere/passes/edge_contact.hpp"
#include "bin_scenes/core/random.hpp"
#include "boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace bin_scenes::sphere {
namespace {

const Vec3 size(0.06, 0.04, 0.02);

/// Inward from the middle part of the edge x = 0.03, z = 0.01 of a box of that size (m).
Vec3f at_edge(float below_x, float below_z) {
  return {0.03f - below_x, 0.0031f, 0.01f - below_z};
}

float distance_to(const Samples& samples, const Edge& edge, const Vec3f& point) {
  const Vec3f a = samples.nodes[edge.a], v = samples.nodes[edge.b] - a;
  const float t = std::clamp((point - a).dot(v) / v.squaredNorm(), 0.0f, 1.0f);
  return (point - a - t * v).norm();
}

TEST(EdgeGrid, ListsEveryEdgeWithinReachOfAPoint) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  Random random(3, 0, Stream::probe);
  std::size_t listed = 0, within = 0;
  for (int k = 0; k < 2000; ++k) {  // also outside the grid
    const Vec3f point =
        Vec3(random.uniform(-0.04, 0.04), random.uniform(-0.03, 0.03), random.uniform(-0.02, 0.02)).cast<float>();
    const auto [first, last] = shape.fine.edge_grid.near(shape.field, point);
    const auto begin = shape.fine.edge_grid.edges.begin() + first, end = shape.fine.edge_grid.edges.begin() + last;
    listed += static_cast<std::size_t>(end - begin);
    EXPECT_TRUE(std::is_sorted(begin, end));
    for (std::uint32_t e = 0; e < shape.fine.edges.size(); ++e) {
      if (distance_to(shape.fine, shape.fine.edges[e], point) > EdgeGrid::reach * shape.field.cell) continue;
      ++within;
      EXPECT_TRUE(std::binary_search(begin, end, e)) << point.transpose();
    }
  }
  EXPECT_GT(within, 0u);
  EXPECT_LT(listed, 2000 * shape.fine.edges.size() / 4);  // lists, not the whole part
}

Exits exits_at(const Shape& shape, const Vec3f& point) {
  return exits_at_edge(shape.fine, shape.field, edges_near(shape.fine, shape.field, point), point);
}

TEST(Exits, BesideAnEdgeAreStraightToItsFaces) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  const float cell = shape.field.cell;
  float lean = 0;
  for (const float x : {0.1f, 0.3f, 0.5f, 0.6f})
    for (const float z : {0.12f, 0.31f, 0.45f}) {
      const Vec3f point = at_edge(x * cell, z * cell);
      const Exits exits = exits_at(shape, point);
      ASSERT_EQ(exits.count, 2);
      const Vec3f near = x < z ? Vec3f::UnitX() : Vec3f::UnitZ(), far = x < z ? Vec3f::UnitZ() : Vec3f::UnitX();
      EXPECT_LT((exits.exit[0].away - near).norm(), 1e-5f);
      EXPECT_LT((exits.exit[1].away - far).norm(), 1e-5f);
      EXPECT_NEAR(exits.exit[0].distance, -std::min(x, z) * cell, 1e-7f);
      EXPECT_NEAR(exits.exit[1].distance, -std::max(x, z) * cell, 1e-7f);
      Vec3f gradient;
      shape.field.sample(point, gradient);
      lean = std::max(lean, (gradient - near).norm());
    }
  EXPECT_GT(lean, 0.3f);  // the grid alone is far off: what this is for
}

TEST(Exits, OutsideThereIsOneToTheFaceOrToTheEdge) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  const float cell = shape.field.cell;
  const Exits above = exits_at(shape, at_edge(0.4f * cell, -0.3f * cell));
  ASSERT_EQ(above.count, 1);
  EXPECT_LT((above.exit[0].away - Vec3f::UnitZ()).norm(), 1e-5f);
  EXPECT_NEAR(above.exit[0].distance, 0.3f * cell, 1e-7f);
  const Exits beyond = exits_at(shape, at_edge(-0.3f * cell, -0.4f * cell));
  ASSERT_EQ(beyond.count, 1);
  EXPECT_LT((beyond.exit[0].away - Vec3f(0.6f, 0, 0.8f)).norm(), 1e-5f);
  EXPECT_NEAR(beyond.exit[0].distance, 0.5f * cell, 1e-7f);
  EXPECT_EQ(exits_at(shape, at_edge(2 * cell, 0.1f * cell)).count, 0);
}

// A hundredth of a cell is many times what contacts overlap by at rest: what has passed the edge is off its face.
TEST(Exits, WhatHasPassedAnEdgeByMicrometresIsOffTheFace) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  const float cell = shape.field.cell;
  const Exits exits = exits_at(shape, at_edge(-0.01f * cell, 0.02f * cell));
  ASSERT_EQ(exits.count, 1);
  EXPECT_LT((exits.exit[0].away - Vec3f::UnitX()).norm(), 1e-5f);
  EXPECT_NEAR(exits.exit[0].distance, 0.01f * cell, 1e-7f);
}

TEST(Exits, InACornerThereAreThree) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  const float cell = shape.field.cell;
  const Vec3f corner = 0.5f * size.cast<float>();
  const Exits exits = exits_at(shape, corner - cell * Vec3f(0.3f, 0.2f, 0.1f));
  ASSERT_EQ(exits.count, 3);
  EXPECT_LT((exits.exit[0].away - Vec3f::UnitZ()).norm(), 1e-5f);
  EXPECT_LT((exits.exit[1].away - Vec3f::UnitY()).norm(), 1e-5f);
  EXPECT_LT((exits.exit[2].away - Vec3f::UnitX()).norm(), 1e-5f);
}

// Of boxes that stand flush a corner lies beyond the ends of the other's edges by rounding.
TEST(Exits, InACornerThereAreThreeThoughItIsOutByAHair) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  const Vec3f corner = 0.5f * size.cast<float>();
  const Exits exits = exits_at(shape, corner + Vec3f(1e-7f, 1e-7f, -2e-6f));
  ASSERT_EQ(exits.count, 3);
  EXPECT_LT((exits.exit[2].away - Vec3f::UnitZ()).norm(), 1e-5f);
  EXPECT_NEAR(exits.exit[2].distance, -2e-6f, 1e-8f);
}

// A line that leaves the box through the edge is pressed between its faces, not under its edge.
TEST(CrossEdges, NormalsLieBetweenTheFacesOfTheOtherEdge) {
  PartModelPtr part;
  const Shape shape = box_shape(part, size);
  const auto cross = [&](float rise, Vec3f& normal) {
    const Vec3f middle = at_edge(0, 0.05f * shape.field.cell), along = 0.002f * Vec3f(1, 0, rise);
    Touch touch{middle, Vec3f::UnitZ(), -0.05f * shape.field.cell};
    const bool crosses =
        cross_edges(shape.fine, Edge{}, shape.fine, shape.field, middle - along, middle + along, touch) != NO_EDGE;
    normal = touch.gradient;
    return crosses;
  };
  Vec3f normal;
  EXPECT_TRUE(cross(-0.4f, normal));
  EXPECT_LT((normal - Vec3f(0.4f, 0, 1).normalized()).norm(), 1e-4f);
  EXPECT_FALSE(cross(0.4f, normal));
}

// The long edges of two bars cross at 2.5 degrees, corner on corner: they press along the normal of both. Each bar's
// nodes near the crossing are inside the other by less than the edges are, and would press against its faces.
TEST(NarrowPhase, EdgesThatAreNearlyParallelPressAlongTheNormalOfBoth) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3(0.06, 0.01, 0.01), 0.004);
  const float half = 0.005f, depth = 4e-6f;
  const auto quarter = Eigen::AngleAxisf(0.25f * static_cast<float>(M_PI), Vec3f::UnitX());  // an edge up, an edge down
  int met = 0;
  for (const float skew : {0.044f, 0.1f, 0.2f})
    for (const float along : {0.0f, 0.0004f, -0.0007f}) {  // where nodes are should make no difference
      World world = world_of_boxes(shape, 2);
      world.fine = true;
      Body &a = world.bodies[0], &b = world.bodies[1];
      a.q = Quatf(quarter);
      a.rotation = a.q.toRotationMatrix();
      b.q = Quatf(Eigen::AngleAxisf(skew, Vec3f::UnitZ()) * quarter);
      b.rotation = b.q.toRotationMatrix();
      b.x = Vec3f(along, 0, 2 * std::sqrt(2.0f) * half - depth);
      find_pairs(world);
      find_contacts(world);
      ASSERT_EQ(world.manifolds.size(), 1u);
      for (const Contact& c : world.manifolds[0].contacts) {
        const float separation = (b.x + b.q * c.anchor_b - a.q * c.anchor_a).dot(c.normal);
        if (separation > 0) continue;
        ++met;
        EXPECT_LT((c.normal - Vec3f::UnitZ()).norm(), 1e-3f) << skew << " " << along;
        EXPECT_NEAR(separation, -depth, 2e-7f) << skew << " " << along;
      }
    }
  EXPECT_GE(met, 9);
}

// The corner of one box stands on the other's face, less than a cell from its edge: on the face, not on a slope.
TEST(NarrowPhase, ACornerBesideAnEdgeStandsOnTheFace) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3::Constant(0.06), 0.005);
  const float cell = shape.field.cell, depth = 0.05f * cell;
  for (const float from_edge : {0.15f, 0.35f, 0.6f}) {
    World world = world_of_boxes(shape, 2);
    world.fine = true;
    Body& b = world.bodies[1];
    b.q = Quatf::FromTwoVectors(Vec3f(1, 1, 1).normalized(), -Vec3f::UnitZ());
    b.x = Vec3f(0.03f - from_edge * cell, 0.0031f, 0.03f + 0.03f * std::sqrt(3.0f) - depth);
    find_pairs(world);
    find_contacts(world);
    ASSERT_EQ(world.manifolds.size(), 1u);
    ASSERT_GE(world.manifolds[0].contacts.size(), 1u);
    const Contact& c = world.manifolds[0].contacts[0];
    EXPECT_LT((c.normal - Vec3f::UnitZ()).norm(), 1e-4f) << from_edge;
    EXPECT_NEAR((b.x + b.q * c.anchor_b - c.anchor_a).z(), -depth, 1e-6f) << from_edge;
  }
}

// Stacks of boxes whose edges lie above each other are pressed along their faces alone, wherever contacts are.
TEST(NarrowPhase, BoxesFlushOnEachOtherPressUpwardsOnly) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3::Constant(0.04), 0.004);
  for (const float shift : {0.0f, 1e-6f, -3e-6f}) {
    World world = world_of_boxes(shape, 2);
    world.fine = true;
    world.bodies[1].x = Vec3f(shift, -shift, 0.04f - 2e-6f);
    find_pairs(world);
    find_contacts(world);
    ASSERT_EQ(world.manifolds.size(), 1u);
    const auto& contacts = world.manifolds[0].contacts;
    ASSERT_EQ(contacts.size(), static_cast<std::size_t>(max_contacts));
    std::set<std::pair<bool, bool>> corners;  // that have a contact, within one node
    for (const Contact& c : contacts) {
      EXPECT_LT((c.normal - Vec3f::UnitZ()).norm(), 1e-4f) << shift;
      if (c.anchor_a.head<2>().cwiseAbs().minCoeff() > 0.0179f)
        corners.insert({c.anchor_a.x() > 0, c.anchor_a.y() > 0});
    }
    EXPECT_EQ(corners.size(), 4u) << shift;
  }
}

// What closes by more than that in a step is met before it touches: all of a face is as far away then.
TEST(NarrowPhase, FacesAboutToMeetHaveAsManyContactsAsThoseThatTouch) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3(0.06, 0.01, 0.01), 0.004);
  for (const float gap : {0.0f, 0.0008f, 0.0016f}) {
    World world = world_of_boxes(shape, 2);
    world.settings.time_step = 1 / 120.0f;
    world.bodies[0].v.z() = 0.4f;
    world.bodies[1].x.z() = 0.01f + gap + world.plan().contact_time * world.bodies[0].v.z();
    find_pairs(world);
    find_contacts(world);
    ASSERT_EQ(world.manifolds.size(), 1u);
    EXPECT_EQ(world.manifolds[0].contacts.size(), static_cast<std::size_t>(max_contacts)) << gap;
    for (const Contact& c : world.manifolds[0].contacts) EXPECT_GT(c.normal.z(), 0.999f) << gap;
  }
}

// A plate leans over the rim of a wall, which passes between the nodes of its face.
TEST(NarrowPhase, TheRimOfAWallIsFeltBetweenNodes) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3(0.06, 0.05, 0.01), 0.004);
  const float depth = 3e-5f, tilt = 0.5f;
  for (const Vec3f& touched : {Vec3f(0.0021f, 0.0013f, -0.005f), Vec3f(-0.0104f, 0.0f, -0.005f)}) {
    World world = world_of_boxes(shape, 1);
    world.fine = true;
    world.planes = {{Vec3f::UnitZ(), 0, false}, {Vec3f::UnitX(), -0.2f, true}};
    world.wall_top = 0.1f;
    Body& b = world.bodies[0];
    b.q = Quatf(Eigen::AngleAxisf(tilt, Vec3f::UnitY()));
    b.rotation = b.q.toRotationMatrix();
    const Vec3f up = b.rotation * Vec3f::UnitZ(), on_rim(-0.2f, 0.01f, 0.1f);
    b.x = on_rim - depth * up - b.rotation * touched;
    find_pairs(world);
    find_contacts(world);
    ASSERT_EQ(world.manifolds.size(), 1u);
    int on_it = 0;
    for (const Contact& c : world.manifolds[0].contacts) {
      const Vec3f on_bin = c.anchor_b;
      if ((Vec3f(on_bin.x(), on_rim.y(), on_bin.z()) - on_rim).norm() > 1e-5f) continue;
      ++on_it;
      EXPECT_LT((c.normal + up).norm(), 1e-3f);
      EXPECT_NEAR((on_bin - b.x - b.q * c.anchor_a).dot(c.normal), -depth, 1e-6f);
    }
    EXPECT_GE(on_it, 1);
  }
}

// Bounds 150 degrees apart: projected to and fro, what lies far outside shrinks slowly, and askew.
TEST(Cone, LeavesNothingOfWhatIsFarOutside) {
  const float across = std::sin(static_cast<float>(M_PI) / 12), along = std::cos(static_cast<float>(M_PI) / 12);
  Cone cone;
  cone.bounds = 3;
  cone.bound[0] = Vec3f(along, across, 0);
  cone.bound[1] = Vec3f(-along, across, 0);
  cone.bound[2] = Vec3f::UnitZ();
  int kept = 0;
  for (int k = 0; k < 72; ++k) {
    const float angle = static_cast<float>(M_PI) * k / 36;
    const Vec3f asked(std::cos(angle), std::sin(angle), 0);
    Vec3f direction = asked;
    if (!turn_into_cone(cone, direction, 0.99f)) continue;
    ++kept;
    EXPECT_GT(direction.dot(asked), 0.98f);
    for (int i = 0; i < cone.bounds; ++i) EXPECT_LT(asked.dot(cone.bound[i]), 0.15f) << k;
  }
  EXPECT_GE(kept, 5);  // 30 degrees wide, and 8 to each side
  EXPECT_LE(kept, 11);
}

// Their normals would be means of two faces, and the only exit in which they can be pressed.
TEST(Samples, NodesOfFacesDoNotStandOnSharpEdges) {
  for (const Vec3& edges : {Vec3(0.06, 0.01, 0.01), Vec3(0.04, 0.04, 0.04), Vec3(0.1, 0.03, 0.002)}) {
    PartModelPtr part;
    const Shape shape = box_shape(part, edges, 0.004);
    for (const Samples* samples : {&shape.coarse, &shape.fine})
      for (const Cone& cone : samples->cones) {
        if (cone.axis.isZero()) continue;
        EXPECT_GT(cone.axis.cwiseAbs().maxCoeff(), 0.999f) << edges.transpose();
      }
  }
}

TEST(Samples, TheEndOfAConcaveEdgeIsPressedAwayFromItsFaces) {
  Mesh mesh;  // an L, 20 mm on a leg, 10 mm wide and high
  const double outline[6][2] = {{0, 0}, {0.02, 0}, {0.02, 0.01}, {0.01, 0.01}, {0.01, 0.02}, {0, 0.02}};
  for (const double z : {0.0, 0.01})
    for (const auto& p : outline) mesh.vertices.push_back({p[0], p[1], z});
  for (std::uint32_t i = 1; i < 5; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({6, 6 + i, 7 + i});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t k = (i + 1) % 6;
    mesh.triangles.push_back({i, k, 6 + k});
    mesh.triangles.push_back({i, 6 + k, 6 + i});
  }
  const PartModelPtr part = PartModel::from_mesh(mesh, "angle");
  const Shape shape = make_shape(*part, 64, 400, 0.01);
  const Vec3f inner = Vec3f(0.01f, 0.01f, 0.01f) - part->mass().center.cast<float>();
  const Cone* cone = nullptr;
  for (std::size_t i = 0; i < shape.fine.nodes.size(); ++i)
    if ((shape.fine.nodes[i] - inner).norm() < 1e-6f) cone = &shape.fine.cones[i];
  ASSERT_TRUE(cone);
  EXPECT_NE(bounds_of(*cone), 0u);
  for (const Vec3f& out : {Vec3f(Vec3f::UnitX()), Vec3f(Vec3f::UnitY()), Vec3f(Vec3f::UnitZ())}) {
    Vec3f direction = out, back = -out;
    EXPECT_TRUE(turn_into_cone(*cone, direction, 0.99f));
    EXPECT_FALSE(turn_into_cone(*cone, back, 0.99f));
  }
}

}  // namespace
}  // namespace bin_scenes::sphere
