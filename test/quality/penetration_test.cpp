#include "bin_scenes/quality/quality.hpp"

#include "part/shapes.hpp"
#include "quality/clearance.hpp"
#include "quality/crossings.hpp"
#include "quality/pieces.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

using test::bar;
using test::clearance;
using test::ring;
using test::sphere_mesh;

constexpr double exact = 1e-9;  // parts are about 1 m long

double depth(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b) {
  return penetration(MeshQuery(a), pose_a, MeshQuery(b), pose_b).depth;
}

Pose at(double x, double y, double z, const Quat& turn = Quat::Identity()) {
  return {Vec3(x, y, z), turn};
}

Quat turned(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

TEST(Penetration, ApartIsZero) {
  const Mesh box = bar({1, 1, 1}).mesh;
  EXPECT_EQ(depth(box, at(0, 0, 0), box, at(1.001, 0, 0)), 0.0);
  EXPECT_EQ(depth(box, at(0, 0, 0), box, at(0.9, 0.9, 1.001)), 0.0);
}

TEST(Penetration, FacesThatOnlyTouchAreNoOverlap) {
  const Mesh box = bar({1, 1, 1}).mesh;
  EXPECT_LE(depth(box, at(0, 0, 0), box, at(0, 0, 1)), exact);
  EXPECT_LE(depth(box, at(0, 0, 0), box, at(0.3, -0.2, 1)), exact);
  EXPECT_LE(depth(box, at(0, 0, 0), box, at(1, 1, 1)), exact);
}

TEST(Penetration, StackedBoxesFlushOrShifted) {
  const Mesh box = bar({1, 1, 1}).mesh;
  for (const double d : {1e-5, 1e-3, 0.02, 0.3}) {
    EXPECT_NEAR(depth(box, at(0, 0, 0), box, at(0, 0, 1 - d)), d, exact) << d;
    EXPECT_NEAR(depth(box, at(0, 0, 0), box, at(0.4, -0.2, 1 - d)), d, exact) << d;
    EXPECT_NEAR(depth(box, at(0, 0, 0), box, at(0.1, 0.2, 1 - d, turned(0.5, Vec3::UnitZ()))), d, exact) << d;
  }
}

TEST(Penetration, DirectionMovesTheSecondAway) {
  const Mesh box = bar({1, 1, 1}).mesh;
  const MeshQuery query(box);
  const Penetration found = penetration(query, at(0, 0, 0), query, at(0.3, 0.1, 0.98));
  EXPECT_NEAR((found.direction - Vec3::UnitZ()).norm(), 0.0, exact);
  EXPECT_NEAR(found.point.z(), 0.49, 0.011);
}

TEST(Penetration, CornerInFace) {
  const Mesh box = bar({1, 1, 1}).mesh;
  const Quat on_corner = Quat::FromTwoVectors(Vec3(1, 1, 1).normalized(), -Vec3::UnitZ());
  const double reach = std::sqrt(0.75);  // from the middle to a corner
  for (const double d : {1e-4, 0.01, 0.1}) {
    EXPECT_NEAR(depth(box, at(0, 0, 0), box, at(0.1, 0.2, 0.5 + reach - d, on_corner)), d, exact) << d;
  }
}

TEST(Penetration, CrossedEdgesWithoutAnyCornerInside) {
  // Two square bars with an edge up and an edge down, at right angles and at 40 degrees.
  const Mesh rod = bar({1, 0.1, 0.1}).mesh;
  const Quat edge_up = turned(M_PI / 4, Vec3::UnitX());
  const double half = std::sqrt(0.5) * 0.1;
  for (const double crossing : {M_PI / 2, 40.0 * M_PI / 180.0}) {
    for (const double d : {1e-4, 0.005, 0.02}) {
      const Pose above = at(0.1, 0.05, 2.0 * half - d, turned(crossing, Vec3::UnitZ()) * edge_up);
      EXPECT_NEAR(depth(rod, at(0, 0, 0, edge_up), rod, above), d, exact) << crossing << " " << d;
    }
  }
}

TEST(Penetration, ThinPlateCutByAnotherLeavesSideways) {
  // A plate of 1 mm stands across the edge of another, 20 mm deep: aside by half of each is shorter than back out.
  const Mesh plate = bar({1, 1, 0.001}).mesh;
  EXPECT_NEAR(depth(plate, at(0, 0, 0), plate, at(0.98, 0.0, 0.0004)), 0.0006, exact);
}

TEST(Penetration, Spheres) {
  const Mesh ball = sphere_mesh(0.5, 4);
  // Vertices at the poles meet; the shortest way out is along a facet beside them, tilted by 4 degrees.
  for (const double d : {1e-4, 1e-3, 0.02}) {
    EXPECT_NEAR(depth(ball, at(0, 0, 0), ball, at(0, 0, 1 - d)), d, 0.003 * d) << d;
  }
  // Elsewhere facets lie up to 1 - cos(half an edge) below the sphere.
  const Vec3 aside = Vec3(1, 2, 3).normalized() * 0.98;
  EXPECT_NEAR(depth(ball, at(0, 0, 0), ball, {aside, turned(1.0, Vec3(3, 1, 0))}), 0.02, 2.0 * 0.5 * 0.005);
}

TEST(Penetration, RingAroundABarThoughHullsOverlap) {
  const Mesh washer = ring(0.5, 0.3, 0.1, 24).mesh, rod = bar({0.2, 0.2, 2}).mesh;
  EXPECT_EQ(depth(washer, at(0, 0, 0), rod, at(0, 0, 0)), 0.0);
  EXPECT_EQ(depth(washer, at(0, 0, 0), rod, at(0.1, 0, 0.5)), 0.0);
  // A facet's middle faces +x at cos(half a facet) of the radius: the bar's face at 0.1 + x meets it.
  const double wall = 0.3 * std::cos(M_PI / 24);
  const Quat facet_to_x = turned(M_PI / 24, Vec3::UnitZ());
  const Mesh slim = bar({0.2, 0.03, 2}).mesh;
  EXPECT_NEAR(depth(washer, at(0, 0, 0, facet_to_x), slim, at(wall - 0.1 + 0.004, 0, 0)), 0.004, exact);
}

TEST(Penetration, BoltInAHoleOfTheSameFacets) {
  const Mesh washer = ring(0.5, 0.3, 0.1, 24).mesh;
  const auto bolt = [](double radius) { return ring(radius, 0.01, 1.0, 24).mesh; };
  EXPECT_EQ(depth(washer, at(0, 0, 0), bolt(0.299), at(0, 0, 0)), 0.0);
  // 2 mm too thick all round: every facet is passed by as much.
  EXPECT_NEAR(depth(washer, at(0, 0, 0), bolt(0.302), at(0, 0, 0)), 0.002 * std::cos(M_PI / 24), 1e-4);
}

TEST(Penetration, InnerCornerIsAsDeepAsTheDeeperArm) {
  // A box pressed into the inner corner of an L by 3 mm and 7 mm.
  const Mesh l = test::angle(0.2, 0.3).mesh, box = bar({0.4, 0.4, 0.2}).mesh;
  EXPECT_NEAR(depth(l, at(0, 0, 0), box, at(0.4 - 0.003, 0.4 - 0.007, 0)), 0.007, exact);
  const Mesh wide = bar({0.4, 0.4, 0.6}).mesh;
  EXPECT_NEAR(depth(l, at(0, 0, 0), wide, at(0.4 - 0.003, 0.4 - 0.007, 0)), 0.007, exact);
}

TEST(Penetration, OneInsideTheOther) {
  const Mesh box = bar({1, 1, 1}).mesh, small = bar({0.1, 0.1, 0.1}).mesh;
  EXPECT_NEAR(depth(box, at(0, 0, 0), small, at(0.1, 0.2, 0)), 0.35, exact);
  EXPECT_NEAR(depth(small, at(0.1, 0.2, 0), box, at(0, 0, 0)), 0.35, exact);
  EXPECT_NEAR(depth(box, at(0, 0, 0), box, at(0, 0, 0)), 1.0, exact);
}

TEST(Penetration, InAHollowPartIsOutside) {
  Mesh shell = test::box_mesh({1, 1, 1});
  test::append(shell, test::inverted(test::box_mesh({0.8, 0.8, 0.8})));
  const Mesh small = bar({0.1, 0.1, 0.1}).mesh;
  EXPECT_EQ(depth(shell, at(0, 0, 0), small, at(0, 0, 0)), 0.0);
  EXPECT_NEAR(depth(shell, at(0, 0, 0), small, at(0, 0, 0.353)), 0.003, exact);
}

TEST(Penetration, IsTheSameAfterACommonMotionAndFromEitherSide) {
  const MeshQuery l(test::angle(0.15, 0.2).mesh), u(test::channel(0.15, 0.15).mesh);
  Random random(3, 0, Stream::probe);
  int overlaps = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose a{Vec3::Zero(), random.orientation()};
    const Vec3 to = random.orientation() * Vec3::UnitX();
    Pose b{to, random.orientation()};
    while (b.position.norm() > 0.01 && clearance(l, a, u, b, 1.0) > 0.0) b.position -= 0.01 * to;
    const double once = penetration(l, a, u, b).depth;
    overlaps += once > 0.0;
    const Pose motion{Vec3(0.3, -1.0, 2.0), random.orientation()};
    EXPECT_NEAR(penetration(l, motion * a, u, motion * b).depth, once, exact) << i;
    EXPECT_NEAR(penetration(u, b, l, a).depth, once, 1e-7) << i;
  }
  EXPECT_GT(overlaps, 50);
}

/// Of all triangles of a with all of b.
std::vector<Crossing> all_crossings(const Mesh& a, const Mesh& b, const Pose& b_in_a, double tolerance) {
  std::vector<Crossing> found;
  for (std::size_t s = 0; s < a.triangles.size(); ++s)
    for (std::size_t t = 0; t < b.triangles.size(); ++t) {
      const Facet one(points_of(a, s), s), other(moved(b_in_a, points_of(b, t)), t);
      if (!one.box.overlaps(other.box, tolerance)) continue;
      if (const auto common = crossing(one, other, tolerance)) found.push_back(*common);
    }
  return found;
}

// The trees are walked in single precision: none is lost, also far from the origin of the file and at flush faces.
TEST(Crossings, AreThoseOfAllPairsOfTrianglesBitForBit) {
  Random random(4, 0, Stream::probe);
  const Mesh turned_ring = ring(0.5, 0.35, 0.2, 24).mesh, ball = sphere_mesh(0.4, 3);
  const auto moved_far = [](Mesh mesh) {
    for (Vec3& x : mesh.vertices) x += Vec3(300.0, -200.0, 100.0);
    return mesh;
  };
  const Mesh far = moved_far(bar({1, 0.8, 0.02}).mesh);
  std::size_t met = 0;
  for (const Mesh* a : {&turned_ring, &ball, &far})
    for (const Mesh* b : {&turned_ring, &ball, &far})
      for (int k = 0; k < 40; ++k) {
        Pose pose{Vec3::Zero(), k % 4 ? random.orientation() : Quat::Identity()};
        const Vec3 apart = k % 4 ? Vec3(random.orientation() * Vec3(0.8 * random.uniform(), 0, 0)) : Vec3(0, 0, 0.02);
        pose.position = a->bounds().center() + apart - pose.orientation * b->bounds().center();
        const std::vector<Crossing> found = crossings(MeshQuery(*a), MeshQuery(*b), pose, 1e-9);
        const std::vector<Crossing> expected = all_crossings(*a, *b, pose, 1e-9);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
          EXPECT_EQ(found[i].triangles, expected[i].triangles);
          EXPECT_EQ(found[i].point, expected[i].point);
        }
        met += !found.empty();
      }
  EXPECT_GT(met, 200u);
}

TEST(BinPenetration, FloorWallsAndRim) {
  Bin bin;
  bin.inner_size = {0.4, 0.3, 0.2};
  const MeshQuery box(bar({0.1, 0.1, 0.1}).mesh);
  const auto in_bin = [&](const Pose& pose) { return bin_penetration(box, pose, bin, nullptr).depth; };
  EXPECT_EQ(in_bin(at(0, 0, 0.05)), 0.0);
  EXPECT_NEAR(in_bin(at(0, 0, 0.047)), 0.003, exact);
  EXPECT_NEAR(in_bin(at(0.152, 0, 0.1)), 0.002, exact);
  EXPECT_NEAR(in_bin(at(0, -0.104, 0.1)), 0.004, exact);
  EXPECT_EQ(in_bin(at(0.2, 0, 0.251)), 0.0) << "above the rim there is no wall";
  EXPECT_NEAR(in_bin(at(0.2, 0, 0.249)), 0.001, exact) << "what lies on the rim is lifted off it, not drawn in";
  const MeshQuery rod(bar({0.4, 0.02, 0.02}).mesh);
  for (const double deep : {-1e-3, 5e-3, 0.01}) {
    const Quat leaning = turned(-M_PI / 4.0, Vec3::UnitY());
    const Vec3 off = leaning * Vec3::UnitZ();  // its underside stands so far off the rim in the middle of the rod
    const Pose over_the_rim = at(0.2, 0, 0.2, leaning) * Pose{Vec3(0, 0, 0.01 - deep), Quat::Identity()};
    EXPECT_NEAR(bin_penetration(rod, over_the_rim, bin, nullptr).depth, std::max(0.0, deep) * off.z(), exact)
        << "no corner of it is in the wall";
  }
  bin.kind = Bin::Kind::floor;
  EXPECT_NEAR(in_bin(at(5, 0, 0.049)), 0.001, exact);
  EXPECT_EQ(in_bin(at(5, 0, 0.05)), 0.0);
  bin.kind = Bin::Kind::none;
  EXPECT_EQ(in_bin(at(0, 0, -1)), 0.0);
}

TEST(BinPenetration, MeshBinClosedOrASheetOfEitherOrientation) {
  Bin bin;
  bin.kind = Bin::Kind::mesh;
  bin.pose = at(0, 0, 1, turned(0.3, Vec3::UnitZ()));
  const MeshQuery box(bar({0.1, 0.1, 0.1}).mesh);
  const MeshQuery slab(test::box_mesh({2, 2, 0.2}, {0, 0, -0.1}));
  Mesh flat;
  flat.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  const MeshQuery up(flat), down(test::inverted(flat));
  for (const MeshQuery* floor : {&slab, &up, &down}) {
    EXPECT_NEAR(bin_penetration(box, at(0.2, 0, 1.047), bin, floor).depth, 0.003, exact);
    EXPECT_EQ(bin_penetration(box, at(0.2, 0, 1.051), bin, floor).depth, 0.0);
  }
}

}  // namespace
}  // namespace bin_scenes
