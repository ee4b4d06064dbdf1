/// Contacts that are found, against where surfaces touch.
#include "bin_scenes/core/random.hpp"
#include "boxes.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/passes/reduce.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {
namespace {

TEST(NarrowPhase, CornerInAFaceGivesDepthAndNormal) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.06}, 0.005);
  World world = world_of_boxes(shape, 2);
  world.fine = true;
  // b stands on a corner above the middle of a's top face, 1 mm deep.
  Body& b = world.bodies[1];
  b.q = Quatf::FromTwoVectors(Vec3f(1, 1, 1).normalized(), -Vec3f::UnitZ());
  b.x = Vec3f(0, 0, 0.03f + 0.03f * std::sqrt(3.0f) - 0.001f);
  find_pairs(world);
  find_contacts(world);
  ASSERT_EQ(world.manifolds.size(), 1u);
  const Manifold& m = world.manifolds[0];
  ASSERT_GE(m.contacts.size(), 1u);
  EXPECT_NEAR((m.contacts[0].normal - Vec3f::UnitZ()).norm(), 0, 1e-3f);
  const Vec3f on_b = b.x + b.q * m.contacts[0].anchor_b, on_a = m.contacts[0].anchor_a;
  EXPECT_NEAR((on_b - on_a).z(), -0.001f, 1e-5f);
}

TEST(NarrowPhase, CrossedEdgesMeetBetweenNodes) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.2, 0.02, 0.02}, 0.004);
  const float depth = 0.0005f;
  World world = crossed_bars(shape, depth);
  find_pairs(world);
  find_contacts(world);
  ASSERT_EQ(world.manifolds.size(), 1u);
  const Manifold& m = world.manifolds[0];
  ASSERT_GE(m.contacts.size(), 1u);
  const Contact& c = m.contacts[0];
  EXPECT_NEAR((c.normal - Vec3f::UnitZ()).norm(), 0, 1e-4f);
  const Vec3f on_a = world.bodies[0].q * c.anchor_a;
  EXPECT_NEAR(on_a.x(), 0.0137f, 1e-5f);
  const Vec3f on_b = world.bodies[1].x + world.bodies[1].q * c.anchor_b;
  EXPECT_NEAR((on_b - on_a).z(), -depth, 1e-6f);
}

/// Of two cubes of 6 cm, b above a, a gap between them and b falling: the manifold once contacts were found.
World falling_cube(const Shape& shape, float gap, float speed) {
  World world = world_of_boxes(shape, 2);
  world.fine = true;
  world.bodies[1].x = Vec3f(0, 0, 0.06f + gap);
  world.bodies[1].v = Vec3f(0, 0, -speed);
  find_pairs(world);
  find_contacts(world);
  return world;
}

TEST(NarrowPhase, ContactsAreFoundWithinTheMarginAndTheWayOfAStep) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.06}, 0.005);
  World world = falling_cube(shape, 0, 0);
  const float dt = world.settings.time_step, kept = world.settings.margin * world.smallest_size;
  const float fall = world.gravity.norm() * dt * dt, rounding = 1e-6f;
  for (const float speed : {0.0f, 0.05f}) {
    const float reach = kept + fall + speed * dt, to_contact_time = 0.5f * speed * dt;  // displacement
    world = falling_cube(shape, reach - rounding, speed);
    ASSERT_EQ(world.manifolds.size(), 1u);
    EXPECT_GE(world.manifolds[0].contacts.size(), 4u) << speed;
    world = falling_cube(shape, reach + to_contact_time + rounding, speed);
    if (world.manifolds.empty()) continue;
    EXPECT_TRUE(world.manifolds[0].contacts.empty()) << speed;
    color_manifolds(world);
    EXPECT_TRUE(world.order.empty());
  }
}

// A cube that tumbles over the floor on an edge: its lowest points are those of half way through the step.
TEST(NarrowPhase, ContactsAreFoundHalfWayThroughTheStep) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3::Constant(0.06));
  World world = world_of_boxes(shape, 1);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  world.fine = true;
  Body& b = world.bodies[0];
  const float turn = 0.7f, half = 0.5f * (world.settings.time_step - world.plan().sub_step);
  b.q = Eigen::AngleAxisf(turn, Vec3f::UnitY());
  b.x = Vec3f(0, 0, 0.0424f);
  b.v = Vec3f(0.3f, 0, -0.1f);
  b.w = Vec3f(0, 20.0f, 0);
  find_pairs(world);
  find_contacts(world);
  ASSERT_EQ(world.manifolds.size(), 1u);
  const Eigen::AngleAxisf there(turn + 20.0f * half, Vec3f::UnitY());
  const Vec3f corner = b.x + half * b.v + there * Vec3f(0.03f, 0, -0.03f);  // of the edge that is below, its middle
  float nearest = 1.0f;
  for (const Contact& c : world.manifolds[0].contacts)
    nearest = std::min(nearest, (c.anchor_b - Vec3f(corner.x(), c.anchor_b.y(), 0)).norm());
  EXPECT_LT(nearest, 1e-6f);
  EXPECT_GT(std::abs(corner.x() - (b.x + b.q * Vec3f(0.03f, 0, -0.03f)).x()), 1e-4f);
}

// The grid of the field rounds edges off, even three cells in front of them. With its distances, corners met the other
// face later than the middle of the face did, and cubes turned in an impact.
TEST(NarrowPhase, FacesThatMeetFastTouchEverywhereAtOnce) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.06}, 0.0043);
  for (const float gap : {0.004f, 0.006f, 0.008f, 0.010f, 0.012f, 0.014f}) {
    const World world = falling_cube(shape, gap, 8.0f);  // 0.02 m in a step
    ASSERT_EQ(world.manifolds.size(), 1u);
    ASSERT_GE(world.manifolds[0].contacts.size(), 4u);
    for (const Contact& c : world.manifolds[0].contacts)
      EXPECT_NEAR((world.bodies[1].x + c.anchor_b - c.anchor_a).z(), gap, 1e-6f) << gap;
  }
}

/// A square bar along y, its corners cut off in `strips` round a radius of `cut`.
Mesh bar_mesh(double size, double cut, int strips, double length) {
  Mesh mesh;
  std::vector<Eigen::Vector2d> outline;
  for (int corner = 0; corner < 4; ++corner)
    for (int i = 0; i <= strips; ++i) {
      const double turn = 0.5 * M_PI * (corner + static_cast<double>(i) / strips), middle = 0.5 * M_PI * corner;
      const Eigen::Vector2d center = (0.5 * size - cut) * std::sqrt(2.0) *
                                     Eigen::Vector2d(std::cos(middle + M_PI / 4), std::sin(middle + M_PI / 4));
      outline.push_back(center + cut * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
    }
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const double y : {-0.5 * length, 0.5 * length})
    for (const auto& p : outline) mesh.vertices.emplace_back(p.x(), y, p.y());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, count + i, next});
    mesh.triangles.push_back({next, count + i, count + next});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, i, next});
    mesh.triangles.push_back({count, count + next, count + i});
  }
  return mesh;
}

// Edges rounded by strips that bend too little for sharp edges and are too narrow for nodes of faces.
TEST(NarrowPhase, RoundedEdgesAreFelt) {
  const PartModelPtr part = PartModel::from_mesh(bar_mesh(0.03, 0.0006, 16, 0.1), "bar");
  const Shape shape = make_shape(*part, 200, 1000, 0.004);
  World world = world_of_boxes(shape, 2);
  world.fine = true;
  // Crossed bars, each on its edge: they meet edge on edge, at a point where neither has a vertex.
  Body &lower = world.bodies[0], &upper = world.bodies[1];
  const Quatf on_edge(Eigen::AngleAxisf(0.25f * static_cast<float>(M_PI), Vec3f::UnitY()));
  lower.q = on_edge;
  upper.q = Quatf(Eigen::AngleAxisf(0.5f * static_cast<float>(M_PI), Vec3f::UnitZ())) * on_edge;
  double reach = 0;  // of the outline, upwards
  for (const Vec3& v : part->mesh().vertices) reach = std::max(reach, (on_edge.cast<double>() * v).z());
  const float depth = 2e-4f;
  upper.x = Vec3f(0.0123f, 0.0077f, 2.0f * static_cast<float>(reach) - depth);
  find_pairs(world);
  find_contacts(world);
  ASSERT_EQ(world.manifolds.size(), 1u);
  float felt = 0;
  for (const Contact& c : world.manifolds[0].contacts)
    felt = std::max(felt, (lower.x + lower.q * c.anchor_a - upper.x - upper.q * c.anchor_b).z());
  EXPECT_NEAR(felt, depth, 5e-4f * shape.size);
}

// More sharp edges than nodes are asked for: the sharpest are kept, and those of a chamfer of 45 degrees among them.
TEST(Samples, AChamferHasItsEdgesHoweverManyThereAre) {
  const PartModelPtr part = PartModel::from_mesh(bar_mesh(0.03, 0.003, 1, 0.1), "bar");
  constexpr double angle = 0.15;
  const Samples samples = make_samples(*part, folds_of(part->mesh(), angle), 4, angle, 1.0);
  double along_y = 0;
  for (const Edge& edge : samples.edges) along_y += std::abs(samples.nodes[edge.b].y() - samples.nodes[edge.a].y());
  EXPECT_NEAR(along_y, 8 * 0.1, 1e-5);
}

// Plates side by side on a floor, all their coarse samples on edges that are level with the other's faces: the way out
// is sideways, not the face at hand, however deep one is in the other.
TEST(NarrowPhase, PlatesThatLieFlushArePushedApartSideways) {
  PartModelPtr part;
  const Vec3 size(0.08, 0.1, 0.006);
  const Shape shape = box_shape(part, size, 0.004);
  for (const float overlap : {-1e-4f, 1e-4f, 3e-4f, 6e-4f, 1e-3f}) {  // the field's cell is 0.5 mm
    for (const float up : {0.0f, 1e-7f, 1e-5f}) {
      for (const float along : {0.0f, 1e-7f, 0.02f}) {
        World world = world_of_boxes(shape, 2);
        world.bodies[1].x = Vec3f(static_cast<float>(size.x()) - overlap, along, up);
        find_pairs(world);
        find_contacts(world);
        ASSERT_EQ(world.manifolds.size(), 1u);
        const Manifold& m = world.manifolds[0];
        Aabb span;
        for (const Contact& c : m.contacts) {
          const Vec3f apart = world.bodies[1].x + c.anchor_b - c.anchor_a;
          // The grid rounds off what lies within a cell of an edge.
          EXPECT_NEAR(apart.dot(c.normal), -overlap, 0.6f * shape.field.cell) << overlap << " " << up << " " << along;
          EXPECT_GT(c.normal.x(), 0.9f) << overlap << " " << up << " " << along;
          span.extend(c.anchor_a.cast<double>());
        }
        ASSERT_GE(m.contacts.size(), 2u) << overlap << " " << up << " " << along;
        EXPECT_GT(span.size().y(), 0.07) << overlap << " " << up << " " << along;
      }
    }
  }
}

// Deep inside, the nearest face is rarely the one that was passed: of two cubes side by side a point near an edge of
// the face that went in is nearest to the side of the other, which it would leave along its own surface.
TEST(NarrowPhase, WhatIsDeepInsideIsPushedOutTheWayItCameIn) {
  PartModelPtr part;
  const float edge = 0.05f;
  const Shape shape = box_shape(part, Vec3::Constant(edge), 0.004);
  for (const float share : {0.1f, 0.25f, 0.45f}) {
    for (const Vec3f& aside : {Vec3f(0, 0, 0), Vec3f(0, 1e-6f, 0), Vec3f(0, 0.003f, 0), Vec3f(0, 0.003f, -0.004f)}) {
      SCOPED_TRACE(::testing::Message() << share << ", aside by " << aside.transpose());
      World world = world_of_boxes(shape, 2);
      world.bodies[1].x = Vec3f((1 - share) * edge, 0, 0) + aside;
      find_pairs(world);
      find_contacts(world);
      ASSERT_EQ(world.manifolds.size(), 1u);
      const Manifold& m = world.manifolds[0];
      EXPECT_GE(m.contacts.size(), 4u);
      for (const Contact& c : m.contacts) {
        EXPECT_GT(c.normal.x(), 0.999f);
        const Vec3f apart = world.bodies[1].x + c.anchor_b - c.anchor_a;
        EXPECT_NEAR(apart.dot(c.normal), -share * edge, 0.5f * shape.field.cell);
      }
    }
  }
}

// Where the bounds of a cone cancel, as of a seam in a flat face, it has no middle to go back along.
TEST(NarrowPhase, WhatHasNoWayBackIsNoContact) {
  PartModelPtr part;
  const float edge = 0.05f;
  Shape shape = box_shape(part, Vec3::Constant(edge), 0.004);
  Cone seam;
  seam.bounds = 2;
  seam.bound[0] = Vec3f::UnitX();
  seam.bound[1] = -Vec3f::UnitX();
  ASSERT_TRUE(axis_direction(seam).isZero());
  std::fill(shape.coarse.cones.begin(), shape.coarse.cones.end(), seam);
  for (Edge& each : shape.coarse.edges) each.cone = seam;
  World world = world_of_boxes(shape, 2);
  world.bodies[1].x = Vec3f(0.75f * edge, 0, 0);
  find_pairs(world);
  find_contacts(world);
  for (const Manifold& m : world.manifolds)
    for (const Contact& c : m.contacts) EXPECT_LT(std::abs(c.normal.x()), 0.1f);
}

// Where coarse samples give way to fine ones, the same number is another point.
// The contacts of a pair were all along the wall, and the part overlapped the other one by what it falls in a step.
TEST(Choice, OfAPartThatFallsAlongAWallIncludesThePlaceWhereItLands) {
  const float size = 0.05f;
  Candidates candidates;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Vec3f on_wall(0, 0.004f * static_cast<float>(i), 0.01f);
    candidates.push_back({on_wall, on_wall, Vec3f::UnitX(), 0.0f, i});
  }
  const Vec3f below(0, 0.02f, 0);
  candidates.push_back({below, below + Vec3f(0, 0, 0.002f), Vec3f::UnitZ(), 0.002f, 12});
  const auto is_chosen = [&](float fall) {
    std::vector<int> chosen;
    reduce(candidates, {}, {Vec3f(0, 0, -fall), Vec3f::Zero()}, size, 0.003f, chosen);
    return std::count(chosen.begin(), chosen.end(), 12) == 1;
  };
  EXPECT_TRUE(is_chosen(0.0025f));
  EXPECT_FALSE(is_chosen(0.0015f));  // it does not land in this step
}

TEST(NarrowPhase, ForcesGoByPlaceWhereNumbersMeanOtherPoints) {
  Manifold old;
  old.contacts.resize(1);
  old.contacts[0].feature = 5;
  old.contacts[0].normal = Vec3f::UnitZ();
  old.contacts[0].normal_force = 3;
  std::vector<Contact> fresh(2);
  fresh[0].feature = 5;
  fresh[0].anchor_a = Vec3f(0.02f, 0, 0);
  fresh[1].feature = 9;
  fresh[1].anchor_a = Vec3f(1e-4f, 0, 0);
  for (Contact& c : fresh) c.normal = Vec3f::UnitZ();
  for (const bool found : {false, true}) {
    old.found = found;
    std::vector<Contact> warm = fresh;
    carry_forces(old, warm, 1e-3f);
    EXPECT_EQ(warm[found ? 0 : 1].normal_force, 3);
    EXPECT_EQ(warm[found ? 1 : 0].normal_force, 0);
  }
}

TEST(NarrowPhase, ContactsOfAFaceOnAFaceSpanTheFace) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.02});
  World world = world_of_boxes(shape, 2);
  world.fine = true;
  world.bodies[1].x = Vec3f(0.01f, 0.005f, 0.02f);
  find_pairs(world);
  find_contacts(world);
  ASSERT_EQ(world.manifolds.size(), 1u);
  Aabb span;
  const Manifold& m = world.manifolds[0];
  for (std::size_t i = 0; i < m.contacts.size(); ++i) {
    // Within a cell of an edge of the other part the grid's normal leans over it.
    const Vec3f in_a = m.contacts[i].anchor_a.cwiseAbs(), in_b = m.contacts[i].anchor_b.cwiseAbs();
    const float edge = 0.03f - 2 * shape.field.cell;
    const bool inner =
        m.contacts[i].feature >> 31 ? in_a.head<2>().maxCoeff() < edge : in_b.head<2>().maxCoeff() < edge;
    if (inner) {
      EXPECT_NEAR((m.contacts[i].normal - Vec3f::UnitZ()).norm(), 0, 1e-3f) << i;
    }
    span.extend(m.contacts[i].anchor_a.cast<double>());
  }
  EXPECT_NEAR(span.lower.x(), -0.02, 0.001);
  EXPECT_NEAR(span.upper.x(), 0.03, 0.001);
  EXPECT_NEAR(span.lower.y(), -0.025, 0.001);
  EXPECT_NEAR(span.upper.y(), 0.03, 0.001);
}

/// A strip of sheet bent to two thirds of a circle: outer radius `outer`, `sheet` thick, `width` along z (m).
Mesh bent_strip(double outer, double sheet, double width, int pieces) {
  Mesh mesh;
  for (int i = 0; i <= pieces; ++i) {
    const double angle = 4.2 * i / pieces;
    for (const double r : {outer - sheet, outer})
      for (const double z : {-0.5 * width, 0.5 * width})
        mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const auto last = static_cast<std::uint32_t>(4 * pieces);
  for (std::uint32_t i = 0; i < last; i += 4) {
    quad(i, i + 1, i + 5, i + 4);      // inside
    quad(i + 2, i + 6, i + 7, i + 3);  // outside
    quad(i, i + 4, i + 6, i + 2);      // below
    quad(i + 1, i + 3, i + 7, i + 5);  // above
  }
  quad(0, 2, 3, 1);
  quad(last, last + 1, last + 3, last + 2);
  return mesh;
}

// A contact that slides to the deepest point of a curved face must stop at the face's rim: beyond it nothing can touch.
// The lowest vertex is 0.02 mm deep, and so no contact is deeper.
TEST(NarrowPhase, NoContactOfABentStripIsDeeperThanItsLowestVertex) {
  const PartModelPtr part = PartModel::from_mesh(bent_strip(0.013, 0.001, 0.01, 24), "strip");
  ASSERT_GT(part->mass().volume, 0);
  const Shape shape = make_shape(*part, 200, 1000, 0.004);
  World world = world_of_boxes(shape, 1);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  Random random(7, 0, Stream::probe);
  Body& strip = world.bodies[0];
  std::size_t contacts = 0;
  for (int i = 0; i < 200; ++i) {
    strip.q = random.orientation().cast<float>();
    float lowest = 0;
    for (const Vec3& v : part->mesh().vertices)
      lowest = std::min(lowest, (strip.q * (v.cast<float>() - shape.center)).z());
    strip.x = Vec3f(0, 0, -lowest - 2e-5f);
    world.manifolds.clear();
    find_pairs(world);
    find_contacts(world);
    ASSERT_EQ(world.manifolds.size(), 1u);
    for (const Contact& c : world.manifolds[0].contacts) {
      EXPECT_GT((strip.x + strip.q * c.anchor_a).z(), -2.5e-5f) << i;
      ++contacts;
    }
  }
  EXPECT_GT(contacts, 400u);
}

// The folds of a teapot's handle lie about the angle that makes an edge: edges where it is bent most, a face between
// them. However the teapot lies, its lowest vertex is felt.
TEST(NarrowPhase, WhatSticksOutBetweenEdgesIsFelt) {
  const PartModelPtr part = sample_part("teapot.stl");
  if (!part) GTEST_SKIP() << "BIN_SCENES_MODELS is not set";
  const Shape shape = make_shape(*part, 200, 1000, 0.004);
  World world = world_of_boxes(shape, 1);
  world.fine = true;
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  Random random(7, 0, Stream::probe);
  Body& teapot = world.bodies[0];
  float missed = 0;
  for (int i = 0; i < 1000; ++i) {
    teapot.q = random.orientation().cast<float>();
    float lowest = 0;
    for (const Vec3& v : part->mesh().vertices)
      lowest = std::min(lowest, (teapot.q * (v.cast<float>() - shape.center)).z());
    teapot.x = Vec3f(0, 0, -lowest);
    world.manifolds.clear();
    find_pairs(world);
    find_contacts(world);
    ASSERT_EQ(world.manifolds.size(), 1u);
    float felt = shape.size;
    for (const Contact& c : world.manifolds[0].contacts) felt = std::min(felt, (teapot.x + teapot.q * c.anchor_a).z());
    missed = std::max(missed, felt);
  }
  EXPECT_LT(missed, 0.0025f * shape.size);
}

}  // namespace
}  // namespace bin_scenes::sphere
