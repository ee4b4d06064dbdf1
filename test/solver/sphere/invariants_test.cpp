/// Worlds that were corrupted between two passes: the next pass names what does not hold.
#include "boxes.hpp"
#include "solver/sphere/make_world.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::sphere {
namespace {

/// Three boxes in a row that touch, of which two manifolds are colored.
class InvariantDeath : public ::testing::Test {
 protected:
  InvariantDeath() : shape(box_shape(part, Vec3::Constant(0.02))), world(world_of_boxes(shape, 3)) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    for (int i = 0; i < 3; ++i) world.bodies[i].x = Vec3f(0.01999f * static_cast<float>(i), 0, 0);
    world.least_thickness = world.thinnest = shape.thickness;
    world.whole_step = world.settings.time_step;
    find_pairs(world);
    find_contacts(world);
    color_manifolds(world);
  }

  PartModelPtr part;
  Shape shape;
  World world;
};

TEST_F(InvariantDeath, ManifoldsThatDoNotAscend) {
  ASSERT_EQ(world.manifolds.size(), 2u);
  std::swap(world.manifolds[0], world.manifolds[1]);
  EXPECT_DEATH(find_pairs(world), "manifolds_ascend\\(world\\) \\(find_pairs.cpp");
}

TEST_F(InvariantDeath, AManifoldOfABodyThatIsNotThere) {
  world.manifolds[1].b = 3;
  EXPECT_DEATH(find_pairs(world), "manifolds_ascend\\(world\\) \\(find_pairs.cpp");
}

TEST_F(InvariantDeath, AColorWhoseManifoldsShareABody) {
  ASSERT_NE(world.manifolds[0].color, world.manifolds[1].color);
  world.manifolds[1].color = world.manifolds[0].color;
  EXPECT_DEATH(solve(world), "colors_share_no_body\\(world\\) \\(solve.cpp");
}

TEST_F(InvariantDeath, AQuaternionOfAnotherLength) {
  world.bodies[2].present = true;
  world.bodies[2].asleep = true;  // moved by nothing, so that no pass makes it whole
  world.bodies[2].q.coeffs() *= 1.01f;
  EXPECT_DEATH(step(world), "orientations_are_unit\\(world\\) \\(solve.cpp");
}

TEST_F(InvariantDeath, APoseThatIsNone) {
  EXPECT_DEATH(place(world, 0, {Pose::none(), {}}), "is_rigid\\(state.pose\\) \\(make_world.cpp");
}

TEST_F(InvariantDeath, AForceOnABodyThatIsNotThere) {
  EXPECT_DEATH(set_force(world, 3, Vec3::UnitZ(), Vec3::Zero()), "body < world.bodies.size\\(\\).*make_world.cpp");
}

TEST_F(InvariantDeath, JawsThatAreOneBody) {
  Jaws jaws;
  jaws.first = jaws.second = 1;
  EXPECT_DEATH(set_jaws(world, jaws), "jaws.first != jaws.second.*make_world.cpp");
}

}  // namespace
}  // namespace bin_scenes::sphere
