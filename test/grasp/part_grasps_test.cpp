/// Grasps of shapes for which formulas tell widths, angles, friction, moments and gaps.
#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"
#include "single_part.hpp"

#include <gtest/gtest.h>

#include <set>

namespace bin_scenes {
namespace {

using test::approach, test::closing, test::cup, test::grasps_of, test::mean_distance, test::two_fingers;

/// Grasps on faces of a cube of 40 mm, turned by `turn`.
void expect_grasps_of_a_cube(const PartGrasps& found, const Quat& turn) {
  ASSERT_GT(found.grasps.size(), 5u);
  bool whole_pad = false;
  for (const Grasp& grasp : found.grasps) {
    EXPECT_NEAR(grasp.width, 0.04, 1e-9);
    EXPECT_NEAR(grasp.friction, 0.0, 1e-7);
    EXPECT_NEAR((turn.conjugate() * closing(grasp.pose)).cwiseAbs().maxCoeff(), 1.0, 1e-9);
    EXPECT_LE(grasp.share, 1.0 + 1e-9);
    if (grasp.share < 1.0 - 1e-9) continue;
    whole_pad = true;
    EXPECT_NEAR(grasp.radius, mean_distance(0.012, 0.010), 1e-9);
    const Vec3 axis = closing(grasp.pose), offset = grasp.pose.position;
    EXPECT_NEAR(grasp.lever, (offset - offset.dot(axis) * axis).norm(), 1e-9);
  }
  EXPECT_TRUE(whole_pad);
  EXPECT_GT(found.coverage, 0.6);
  EXPECT_LT(found.coverage, 1.0);
  EXPECT_GT(found.placed.size(), 100u);
}

TEST(ParallelGrasps, CubeIsHeldAtItsWidthByParallelFaces) {
  expect_grasps_of_a_cube(grasps_of(test::box_mesh({0.04, 0.04, 0.04}), two_fingers()), Quat::Identity());
}

TEST(ParallelGrasps, TurnedCubeTheSame) {
  const Pose pose{Vec3(0.1, -0.2, 0.3), Quat(0.3, 0.5, -0.7, 0.2).normalized()};
  Mesh mesh = transformed(test::box_mesh({0.04, 0.04, 0.04}), pose);
  for (Vec3& v : mesh.vertices) v -= pose.position;
  expect_grasps_of_a_cube(grasps_of(mesh, two_fingers()), pose.orientation);
}

/// A cube one of whose faces is a fan of slivers about a point near its corner.
Mesh fan_cube(double edge, int slivers) {
  Mesh mesh = test::box_mesh({edge, edge, edge});
  mesh.triangles.resize(mesh.triangles.size() - 2);  // the face y... of vertices 1 3 7 5: +x
  const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.5 * edge, 0.49 * edge, 0.4 * edge);
  const std::uint32_t corners[] = {1, 3, 7, 5};
  std::vector<std::uint32_t> rim;
  for (int side = 0; side < 4; ++side) {
    const Vec3 from = mesh.vertices[corners[side]], to = mesh.vertices[corners[(side + 1) % 4]];
    rim.push_back(corners[side]);
    for (int i = 1; side == 1 && i < slivers; ++i) {
      rim.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(from + i / double(slivers) * (to - from));
    }
  }
  for (std::size_t i = 0; i < rim.size(); ++i) mesh.triangles.push_back({hub, rim[i], rim[(i + 1) % rim.size()]});
  return mesh;
}

TEST(ParallelGrasps, TessellationDoesNotMatter) {
  const PartGrasps found = grasps_of(fan_cube(0.04, 150), two_fingers());
  ASSERT_GT(found.grasps.size(), 20u);
  std::set<int> axes;
  for (const Grasp& grasp : found.grasps) {
    EXPECT_NEAR(grasp.width, 0.04, 1e-9);
    int axis = 0;
    closing(grasp.pose).cwiseAbs().maxCoeff(&axis);
    axes.insert(axis);
  }
  EXPECT_EQ(axes.size(), 3u);
}

TEST(ParallelGrasps, NothingIsWiderThanTheStroke) {
  Gripper gripper = two_fingers();
  gripper.stroke = 0.0399;
  const PartGrasps found = grasps_of(test::box_mesh({0.04, 0.04, 0.04}), gripper);
  EXPECT_TRUE(found.grasps.empty());
  EXPECT_GT(found.counts.width, 0u);
  EXPECT_EQ(found.counts.good, 0u);
  EXPECT_NE(text_of(found.counts, gripper.type).find("wider than the stroke"), std::string::npos);
}

TEST(ParallelGrasps, CylinderIsHeldAcrossOrAlongItsAxis) {
  constexpr double radius = 0.012, height = 0.03;
  constexpr int sides = 64;
  const PartGrasps found = grasps_of(test::prism_mesh(radius, height, sides), two_fingers());
  bool across = false, along = false;
  for (const Grasp& grasp : found.grasps) {
    const double axial = std::abs(closing(grasp.pose).z());
    if (axial > 0.5) {
      along = true;
      EXPECT_NEAR(axial, 1.0, 1e-9);
      EXPECT_NEAR(grasp.width, height, 1e-9);
    } else {
      across = true;
      EXPECT_NEAR(axial, 0.0, 1e-9);
      EXPECT_GE(grasp.width, 2.0 * radius * std::cos(M_PI / sides) - 1e-9);
      EXPECT_LE(grasp.width, 2.0 * radius + 1e-9);
      // The contact is as wide as the pad's give lets it be: 2 sqrt(2 give radius), 4.4 of the pad's 12 mm.
      const Vec3 y = grasp.pose.orientation * Vec3::UnitY();
      const Vec3 on_axis(0.0, 0.0, grasp.pose.position.z());
      if (std::abs(y.z()) < 0.01 && std::abs(on_axis.z()) < 0.5 * height - 0.005) {
        EXPECT_NEAR(grasp.share, 2.0 * std::sqrt(2.0 * 2e-4 * radius) / 0.012, 0.05);
      }
    }
    EXPECT_LT(grasp.friction, std::tan(M_PI / sides));  // of a round one: 0
  }
  EXPECT_TRUE(across && along);
}

TEST(ParallelGrasps, SphereHasOneGrasp) {
  constexpr double radius = 0.02;
  const PartGrasps found = grasps_of(test::sphere_mesh(radius, 5), two_fingers());
  ASSERT_GE(found.grasps.size(), 1u);
  EXPECT_LE(found.grasps.size(), 4u);   // facets put pads a little off the middle
  EXPECT_GT(found.placed.size(), 50u);  // scenes try it from all sides
  const Grasp& grasp = found.grasps[0];
  EXPECT_NEAR(grasp.width, 2.0 * radius, 5e-5);  // facets
  EXPECT_LT(grasp.lever, 5e-4);
  // Contact is a disc of radius sqrt(2 give radius), of which the mean distance is two thirds.
  const double disc = std::sqrt(2.0 * 2e-4 * radius);
  EXPECT_NEAR(grasp.share, M_PI * disc * disc / (0.012 * 0.010), 0.03);
  EXPECT_NEAR(grasp.radius, 2.0 / 3.0 * disc, 0.1 * disc);
}

TEST(ParallelGrasps, WedgeNeedsTheTangentOfItsHalfAngle) {
  // 24 mm wide at its base, sides leaning in by 0.15 rad.
  const double lean = std::tan(0.15), half = 0.012, height = 0.03;
  const auto body = test::prism(
      {{-half, 0}, {half, 0}, {half - lean * height, height}, {-half + lean * height, height}}, {{0, 1, 2, 3}}, 0.07);
  const auto leaning = [&](double friction) {
    const PartGrasps found = grasps_of(body.mesh, two_fingers(), friction);
    std::size_t count = 0;
    for (const Grasp& grasp : found.grasps) {
      if (std::abs(closing(grasp.pose).x()) < 0.9) continue;
      ++count;
      EXPECT_NEAR(grasp.friction, lean, 1e-9);
    }
    return count;
  };
  EXPECT_EQ(leaning(lean - 0.001), 0u);
  EXPECT_GT(leaning(lean + 0.001), 0u);
}

TEST(ParallelGrasps, RingIsHeldAcrossItsWallOrItsHeight) {
  constexpr double outer = 0.03, inner = 0.022, height = 0.01;
  const PartGrasps found = grasps_of(test::ring(outer, inner, height, 48).mesh, two_fingers());
  std::size_t wall = 0, flat = 0;
  for (const Grasp& grasp : found.grasps) {
    if (std::abs(closing(grasp.pose).z()) > 0.9) {
      ++flat;
      EXPECT_NEAR(grasp.width, height, 1e-9);
    } else {
      // A finger of 12 mm inside rests on two lines of the hole, up to its pad's diagonal apart.
      ++wall;
      EXPECT_GT(grasp.width, (outer - inner) * std::cos(M_PI / 48) - 1e-9);
      EXPECT_LT(grasp.width, outer - std::sqrt(inner * inner - 0.006 * 0.006 - 0.005 * 0.005) + 1e-4);
    }
  }
  EXPECT_GT(wall, 0u);
  EXPECT_GT(flat, 0u);
  // No finger of 8 mm opens in a hole of 8 mm: what is left is the height, and the whole ring, also off its middle,
  // where friction f holds a chord of cos(atan f) of the diameter.
  for (const Grasp& grasp : grasps_of(test::ring(0.02, 0.004, height, 48).mesh, two_fingers()).grasps) {
    const bool flat_on = std::abs(closing(grasp.pose).z()) > 0.9;
    EXPECT_NEAR(grasp.width, flat_on ? height : 0.04 / std::hypot(1.0, grasp.friction),
                5e-4);  // facets, and pads at their edge
  }
}

TEST(ParallelGrasps, PlateIsReachedAsFarAsFingersAreDeep) {
  const Vec3 size(0.16, 0.12, 0.002);
  const Gripper gripper = two_fingers();
  const PartGrasps found = grasps_of(test::box_mesh(size), gripper);
  ASSERT_GT(found.placed.size(), 20u);
  for (const auto& placed : found.placed) {
    EXPECT_NEAR(found.grasps[placed.of].width, size.z(), 1e-9);
    // The corners of the palm's near face stay outside the plate.
    const double behind = gripper.finger_depth - 0.5 * gripper.pad_length;
    const Vec3 palm = placed.pose.position - behind * approach(placed.pose);
    EXPECT_GT((palm.cwiseAbs() - 0.5 * size).maxCoeff(), -1e-5) << palm.transpose();
  }
}

TEST(ParallelGrasps, SymmetriesAreNamedNotRepeated) {
  // The ring has 48 places for each grasp and two sides. No grasp is another one turned.
  const Mesh mesh = test::ring(0.03, 0.022, 0.01, 48).mesh;
  const PartGrasps found = grasps_of(mesh, two_fingers());
  EXPECT_LT(found.grasps.size(), 40u);
  EXPECT_GT(found.placed.size(), 3 * found.grasps.size());
  EXPECT_LE(found.placed.size(), two_fingers().most);
  const MeshQuery query(mesh);
  for (const auto& placed : found.placed)  // wherever it is placed, it touches the part
    for (const Vec3& contact : found.grasps[placed.of].contacts)
      EXPECT_LT(query.nearest(placed.pose * contact).distance, 3e-4);
}

TEST(ParallelGrasps, TheSameTwice) {
  const Mesh mesh = test::l_mesh(0.5);
  Mesh small = mesh;
  for (Vec3& v : small.vertices) v *= 0.02;
  const PartGrasps a = grasps_of(small, two_fingers()), b = grasps_of(small, two_fingers());
  ASSERT_EQ(a.placed.size(), b.placed.size());
  ASSERT_FALSE(a.placed.empty());
  for (std::size_t i = 0; i < a.placed.size(); ++i) EXPECT_EQ(a.placed[i].pose.position, b.placed[i].pose.position);
}

TEST(ParallelGrasps, ThroughTheCacheTheSame) {
  const auto part = PartModel::from_mesh(test::ring(0.03, 0.022, 0.011, 24).mesh, "ring");
  const PartGrasps made = find_grasps(*part, two_fingers(), 0.4);
  for (int time = 0; time < 2; ++time) {  // made or read, then read
    const PartGrasps found = part_grasps(*part, two_fingers(), 0.4);
    ASSERT_EQ(found.grasps.size(), made.grasps.size());
    EXPECT_EQ(found.placed.size(), made.placed.size());
    EXPECT_EQ(found.coverage, made.coverage);
    EXPECT_EQ(found.counts.collision, made.counts.collision);
    for (std::size_t i = 0; i < made.grasps.size(); ++i) {
      EXPECT_EQ(found.grasps[i].pose.position, made.grasps[i].pose.position);
      EXPECT_EQ(found.grasps[i].lever, made.grasps[i].lever);
      EXPECT_EQ(found.grasps[i].contacts.size(), made.grasps[i].contacts.size());
    }
  }
}

TEST(SuctionGrasps, CubeHoldsWhereTheRingLiesOnAFace) {
  constexpr double edge = 0.04;
  const PartGrasps found = grasps_of(test::box_mesh({edge, edge, edge}), cup());
  ASSERT_GT(found.placed.size(), 10u);
  for (const auto& placed : found.placed) {
    EXPECT_NEAR(found.grasps[placed.of].gap, 0.0, 1e-9);
    EXPECT_NEAR(approach(placed.pose).cwiseAbs().maxCoeff(), 1.0, 1e-9);
    const Vec3 away = placed.pose.position.cwiseAbs();
    EXPECT_NEAR(away.maxCoeff(), 0.5 * edge, 1e-9);
    EXPECT_LT(away.sum() - away.maxCoeff() - away.minCoeff(), 0.5 * edge - 0.01 + 1e-9);
  }
}

TEST(SuctionGrasps, CylinderLeavesAGapUnderTheRing) {
  // Ring of radius r across a cylinder of radius R: R - sqrt(R^2 - r^2).
  constexpr double radius = 0.02;
  const Mesh mesh = test::prism_mesh(radius, 0.06, 128);
  const double gap = radius - std::sqrt(radius * radius - 1e-4);
  const auto on_side = [&](double lip) {
    Gripper gripper = cup();
    gripper.lip = lip;
    std::size_t count = 0;
    for (const Grasp& grasp : grasps_of(mesh, gripper).grasps) {
      if (std::abs(approach(grasp.pose).z()) > 0.5) continue;
      ++count;
      EXPECT_NEAR(grasp.gap, gap, 0.02 * gap);
    }
    return count;
  };
  EXPECT_EQ(on_side(0.96 * gap), 0u);
  EXPECT_GT(on_side(1.04 * gap), 0u);
}

TEST(SuctionGrasps, SphereClosesTheRingAllAround) {
  constexpr double radius = 0.02;
  const PartGrasps found = grasps_of(test::sphere_mesh(radius, 5), cup());
  ASSERT_EQ(found.grasps.size(), 1u);
  EXPECT_LT(found.grasps[0].gap, 1e-4);
  EXPECT_NEAR(found.grasps[0].pose.position.norm(), std::sqrt(radius * radius - 1e-4), 1e-4);
}

TEST(SuctionGrasps, RingsKeepTheirMarginToEdgesAndHoles) {
  constexpr double outer = 0.04, hole = 0.012, exact = 3e-5;
  const Mesh mesh = test::ring(outer, hole, 0.005, 64).mesh;
  for (const double margin : {0.001, 0.003}) {
    Gripper gripper = cup();
    gripper.margin = margin;
    const PartGrasps found = grasps_of(mesh, gripper);
    double least = outer;
    for (const PartGrasps::Placed& placed : found.placed) {
      ASSERT_GT(std::abs(approach(placed.pose).z()), 0.99);
      const double from_axis = placed.pose.position.head<2>().norm();
      const double left = std::min(from_axis - hole, outer * std::cos(M_PI / 64) - from_axis) - gripper.radius;
      EXPECT_GT(left, margin - exact);
      EXPECT_LT(found.grasps[placed.of].margin, left + exact);
      least = std::min(least, left);
    }
    EXPECT_LT(least, margin + 0.001);  // the margin is used up
  }
}

TEST(SuctionGrasps, AHoleUnderTheCupLeaks) {
  // The wall of the ring is 16 mm wide: a cup of 20 mm hangs over, one of 10 mm does not.
  const Mesh mesh = test::ring(0.026, 0.010, 0.01, 48).mesh;
  const PartGrasps wide = grasps_of(mesh, cup());
  for (const Grasp& grasp : wide.grasps) EXPECT_LT(std::abs(approach(grasp.pose).z()), 0.5);
  EXPECT_GT(wide.counts.contact, 0u);
  Gripper small = cup();
  small.radius = 0.005;
  std::size_t flat = 0;
  for (const Grasp& grasp : grasps_of(mesh, small).grasps) flat += std::abs(approach(grasp.pose).z()) > 0.5;
  EXPECT_GT(flat, 0u);
}

TEST(InnerGrasps, RingIsExpandedAcrossItsHole) {
  const double hole = 0.022;
  const Mesh mesh = test::ring(0.5 * 0.03, 0.5 * hole, 0.01, 48).mesh;
  Gripper gripper = two_fingers();
  gripper.finger_width = 0.006;
  gripper.finger_thickness = 0.004;
  for (const Grasp& grasp : grasps_of(mesh, gripper).grasps) EXPECT_FALSE(grasp.inner);
  gripper.inner = true;
  const PartGrasps found = grasps_of(mesh, gripper);
  std::size_t within = 0;
  for (const PartGrasps::Placed& placed : found.placed) {
    const Grasp& grasp = found.grasps.at(placed.of);
    if (!grasp.inner) continue;
    ++within;
    // The wall has 48 sides. A pad of 6 x 10 mm touches it at its edges, or turned at its corners.
    EXPECT_LT(grasp.width, hole);
    const bool axial = std::abs(approach(placed.pose).z()) > 0.999;
    const double beside = std::abs((placed.pose.orientation * Vec3::UnitY()).dot(placed.pose.position));
    const double across = beside + (axial ? 0.003 : std::hypot(0.003, 0.005));
    EXPECT_GT(grasp.width, 2.0 * std::sqrt(0.25 * hole * hole - across * across) - 2e-4);
    EXPECT_GT(std::abs(approach(placed.pose).z()), 0.6);
    EXPECT_LT(placed.pose.position.head<2>().norm(), 0.3 * hole);
  }
  EXPECT_GT(within, 3u);
  // Grasps from outside stay the same.
  gripper.inner = false;
  EXPECT_EQ(grasps_of(mesh, gripper).placed.size(), found.placed.size() - within);
}

TEST(InnerGrasps, FingersMustFitIntoTheHole) {
  Gripper gripper = two_fingers();
  gripper.inner = true;
  gripper.finger_width = 0.004;
  for (const double thickness : {0.003, 0.0045, 0.0055, 0.008}) {  // the pads are 11.3 mm apart, with 0.5 mm of room
    gripper.finger_thickness = thickness;
    const PartGrasps found = grasps_of(test::ring(0.012, 0.006, 0.01, 48).mesh, gripper);
    const bool any = std::any_of(found.grasps.begin(), found.grasps.end(), [](const Grasp& g) { return g.inner; });
    EXPECT_EQ(any, thickness < 0.0051) << thickness;
  }
}

}  // namespace
}  // namespace bin_scenes
