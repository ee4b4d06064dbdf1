/// Grasps of shapes for which formulas tell widths, angles, friction, moments and gaps.
#include "bin_scenes/grasp/part_grasps.hpp"

#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <set>

namespace bin_scenes {
namespace {

Gripper two_fingers() {
  Gripper gripper;
  gripper.name = "two";
  gripper.stroke = 0.05;
  gripper.finger_width = 0.012;
  gripper.pad_length = 0.010;
  gripper.finger_depth = 0.04;
  gripper.finger_thickness = 0.008;
  return gripper;
}

Gripper cup() {
  Gripper gripper;
  gripper.name = "cup";
  gripper.type = Gripper::Type::suction;
  gripper.radius = 0.01;
  gripper.lip = 0.001;
  return gripper;
}

PartGrasps grasps_of(const Mesh& mesh, const Gripper& gripper, double friction = 0.4) {
  return find_grasps(*PartModel::from_mesh(mesh, "part"), gripper, friction);
}

Vec3 closing(const Pose& pose) {
  return pose.orientation * Vec3::UnitX();
}
Vec3 approach(const Pose& pose) {
  return pose.orientation * Vec3::UnitZ();
}

/// Mean distance of a rectangle's points from its middle.
double mean_distance(double a, double b) {
  const double d = std::hypot(a, b);
  return d / 6.0 + b * b / (12.0 * a) * std::log((a + d) / b) + a * a / (12.0 * b) * std::log((b + d) / a);
}

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
    EXPECT_NEAR(grasp.width, flat_on ? height : 0.04 / std::hypot(1.0, grasp.friction), 3e-4);
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

/// The rows of the table in docs/lab/accuracy.md.
struct Form {
  const char *part, *quantity;
  double found, expected;  ///< mm, or a coefficient
  double tolerance;
};

/// Mean of a figure of those grasps that have it, mm; NaN without any.
template <class Figure>
double mean_mm(const PartGrasps& found, const Figure& figure) {
  double sum = 0.0, count = 0.0;
  for (const Grasp& grasp : found.grasps)
    if (const std::optional<double> value = figure(grasp)) {
      sum += 1e3 * *value;
      ++count;
    }
  return sum / count;
}

std::vector<Form> forms_of_fingers() {
  using Figure = std::optional<double>;
  const PartGrasps cube = grasps_of(test::box_mesh({0.04, 0.04, 0.04}), two_fingers());
  const PartGrasps cylinder = grasps_of(test::prism_mesh(0.012, 0.03, 64), two_fingers());
  const PartGrasps sphere = grasps_of(test::sphere_mesh(0.02, 5), two_fingers());
  const PartGrasps ring = grasps_of(test::ring(0.03, 0.022, 0.01, 48).mesh, two_fingers());
  const PartGrasps plate = grasps_of(test::box_mesh({0.16, 0.12, 0.002}), two_fingers());
  const auto body = test::prism(
      {{-0.012, 0}, {0.012, 0}, {0.012 - 0.03 * std::tan(0.15), 0.03}, {-0.012 + 0.03 * std::tan(0.15), 0.03}},
      {{0, 1, 2, 3}}, 0.07);
  const PartGrasps wedge = grasps_of(body.mesh, two_fingers());
  const auto width = [](const Grasp& g) { return Figure(g.width); };
  const auto whole_pad = [](const Grasp& g) { return g.share > 1.0 - 1e-9 ? Figure(g.radius) : std::nullopt; };
  const auto along = [](const Grasp& g) {
    return std::abs(closing(g.pose).z()) > 0.5 ? Figure(g.width) : std::nullopt;
  };
  const auto across = [](const Grasp& g) {
    const bool level = std::abs((g.pose.orientation * Vec3::UnitY()).z()) < 0.01 && std::abs(closing(g.pose).z()) < 0.5;
    return level && std::abs(g.pose.position.z()) < 0.01 ? Figure(0.012 * g.share) : std::nullopt;
  };
  const auto leaning = [](const Grasp& g) {
    return std::abs(closing(g.pose).x()) > 0.9 ? Figure(1e-3 * g.friction) : std::nullopt;
  };
  return {{"cube, 40 mm", "width = edge", mean_mm(cube, width), 40.0, 1e-6},
          {"cube, 40 mm", "moment arm = mean distance in the pad", mean_mm(cube, whole_pad),
           1e3 * mean_distance(0.012, 0.010), 1e-6},
          {"cylinder, R = 12 mm", "width along it = height, 30", mean_mm(cylinder, along), 30.0, 1e-6},
          {"the same", "contact across = 2 sqrt(2 g R)", mean_mm(cylinder, across), 2e3 * std::sqrt(2.0 * 2e-4 * 0.012),
           0.05},
          {"sphere, R = 20 mm", "width = 2 R", mean_mm(sphere, width), 40.0, 0.05},
          {"sphere, R = 20 mm", "moment arm = 2/3 sqrt(2 g R)",
           mean_mm(sphere, [](const Grasp& g) { return Figure(g.radius); }), 2e3 / 3.0 * std::sqrt(2.0 * 2e-4 * 0.02),
           0.08},
          {"wedge, sides lean by 0.15 rad", "least friction = tan 0.15", mean_mm(wedge, leaning), std::tan(0.15), 1e-9},
          {"ring, 10 mm high", "width = height", mean_mm(ring, along), 10.0, 1e-6},
          {"plate, 2 mm", "width = thickness", mean_mm(plate, width), 2.0, 1e-6}};
}

std::vector<Form> forms_of_cups() {
  using Figure = std::optional<double>;
  Gripper soft = cup();
  soft.lip = 0.004;
  const PartGrasps cylinder = grasps_of(test::prism_mesh(0.02, 0.06, 128), soft);
  const PartGrasps sphere = grasps_of(test::sphere_mesh(0.02, 5), cup());
  const double deep = std::sqrt(0.02 * 0.02 - 0.01 * 0.01);
  const auto on_side = [](const Grasp& g) {
    return std::abs(approach(g.pose).z()) < 0.5 ? Figure(g.gap) : std::nullopt;
  };
  const auto distance = [](const Grasp& g) { return Figure(g.pose.position.norm()); };
  return {{"cup, r = 10 mm, on cylinder, 20 mm", "gap = R - sqrt(R^2 - r^2)", mean_mm(cylinder, on_side),
           1e3 * (0.02 - deep), 0.005},
          {"the same on a sphere", "ring to centre = sqrt(R^2 - r^2)", mean_mm(sphere, distance), 1e3 * deep, 0.03}};
}

TEST(ClosedForms, AreFound) {
  std::vector<Form> forms = forms_of_fingers();
  for (const Form& form : forms_of_cups()) forms.push_back(form);
  for (const Form& form : forms) {
    std::printf("| %s | %s | %.4g | %.4g |\n", form.part, form.quantity, form.found, form.expected);
    EXPECT_NEAR(form.found, form.expected, form.tolerance) << form.part << ": " << form.quantity;
  }
}

}  // namespace
}  // namespace bin_scenes
