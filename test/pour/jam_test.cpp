/// Squeeze of parts under forces that are known.
#include "pour/jam.hpp"

#include "box_mesh.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

constexpr double g = 9.81, edge = 0.04, weight = 0.5 * g;

class JamTest : public ::testing::Test {
 protected:
  JamTest() {
    world.parts = {PartModel::from_mesh(box_mesh(edge), "box")};
    world.bodies.resize(20);
    for (std::size_t b = 0; b < world.bodies.size(); ++b) {
      world.bodies[b].mass = 0.5;
      states.push_back({});
      states.back().pose.position = Vec3(0, 0, edge * (0.5 + static_cast<double>(b)));
    }
  }
  static ContactForce push(int a, int b, const Vec3& force) { return {a, b, Vec3::Zero(), force.normalized(), force}; }

  WorldDef world;
  std::vector<BodyState> states;
};

TEST_F(JamTest, WhatCarriesAHeapIsNotJammed) {
  std::vector<ContactForce> forces{push(0, -1, Vec3(0, 0, -20 * weight))};
  for (int b = 1; b < 20; ++b) forces.push_back(push(b, b - 1, Vec3(0, 0, -(20 - b) * weight)));
  const JamReport jam = worst_jam(world, states, forces);
  EXPECT_LE(jam.ratio, 1.0);
  EXPECT_TRUE(flags_of(jam).empty());
}

TEST_F(JamTest, WhatWallsSqueezeIs) {
  const Vec3 side(12 * weight, 0, -0.5 * weight);
  const JamReport jam =
      worst_jam(world, states, {push(3, -1, side), push(3, -1, Vec3(-side.x(), 0, side.z())), push(5, -1, side)});
  EXPECT_EQ(jam.part, 3);
  EXPECT_NEAR(jam.ratio, 12.0, 0.1);
  ASSERT_EQ(flags_of(jam).size(), 1u);
  EXPECT_EQ(flags_of(jam)[0].code, "part_jammed");
}

TEST_F(JamTest, ALoadFromAboveExplainsASqueeze) {
  const Vec3 side(30 * weight, 0, 0);
  std::vector<ContactForce> forces{push(0, -1, side), push(0, -1, -side)};
  EXPECT_NEAR(worst_jam(world, states, forces).ratio, 30.0, 1e-9);
  for (int b = 1; b < 20; ++b) forces.push_back(push(b, b - 1, Vec3(0, 0, -(20 - b) * weight)));
  EXPECT_NEAR(worst_jam(world, states, forces).ratio, 1.5, 0.01);
}

TEST_F(JamTest, WithoutGravityThereIsNoWeightToCompareWith) {
  world.gravity.setZero();
  EXPECT_EQ(worst_jam(world, states, {push(0, -1, Vec3(1, 0, 0)), push(0, -1, Vec3(-1, 0, 0))}).part, -1);
}

}  // namespace
}  // namespace bin_scenes
