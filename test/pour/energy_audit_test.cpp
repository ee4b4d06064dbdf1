/// The audit against motions whose energy is known.
#include "pour/energy_audit.hpp"

#include "box_mesh.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

constexpr double g = 9.81, edge = 0.04, dt = 1.0 / 60.0;
const double d = edge * std::sqrt(3.0);

class EnergyAuditTest : public ::testing::Test {
 protected:
  EnergyAuditTest() {
    world.parts = {PartModel::from_mesh(box_mesh(edge), "box")};
    world.bodies.resize(3);
    for (BodyDef& body : world.bodies) body.mass = 0.5;
  }

  static BodyState at(double x, double z, const Vec3& velocity = Vec3::Zero(), const Vec3& spin = Vec3::Zero()) {
    BodyState state;
    state.pose.position = Vec3(x, 0.0, z);
    state.velocity = {velocity, spin};
    return state;
  }
  static BodyState away(int n) { return at(10.0 * n, 1.0); }

  /// The report after two states, one observation apart.
  EnergyReport between(const std::vector<BodyState>& before, const std::vector<BodyState>& after) const {
    EnergyAudit audit(world);
    for (std::size_t b = 0; b < before.size(); ++b) audit.enter(b, before[b]);
    audit.observe(dt, after);
    return audit.worst();
  }

  WorldDef world;
};

TEST_F(EnergyAuditTest, FreeFallAndRestGainNothing) {
  const Vec3 fast(1.0, 0.0, -g * dt);
  const BodyState falling = at(dt, 1.0 - 0.5 * g * dt * dt, fast);
  const EnergyReport report = between({at(0.0, 1.0, Vec3(1, 0, 0)), away(1), away(2)}, {falling, away(1), away(2)});
  EXPECT_EQ(report.gain, 0.0);
  EXPECT_EQ(report.part, -1);
}

TEST_F(EnergyAuditTest, APartThrownUpGainsItsKineticEnergy) {
  const double v = std::sqrt(2.0 * g * 5.0 * d);  // as high as five diagonals
  const EnergyReport report =
      between({away(0), at(0.0, 1.0), away(2)}, {away(0), at(0.0, 1.0, Vec3(0, 0, v)), away(2)});
  EXPECT_NEAR(report.gain, 5.0, 0.01);
  EXPECT_EQ(report.part, 1);
  EXPECT_NEAR(report.time, dt, 1e-12);
}

TEST_F(EnergyAuditTest, SpinCounts) {
  const double inertia = 0.5 * edge * edge / 6.0;
  const Vec3 spin = Vec3(1, 2, 3).normalized() * std::sqrt(2.0 * 0.5 * g * d * 2.0 / inertia);
  EXPECT_NEAR(between({at(0.0, 1.0)}, {at(0.0, 1.0, Vec3::Zero(), spin)}).gain, 2.0, 0.01);
}

TEST_F(EnergyAuditTest, WhatANeighbourGaveIsNoGain) {
  const double v = 2.0;
  const EnergyReport report = between({at(0.0, 1.0, Vec3(v, 0, 0)), at(edge, 1.0), away(2)},
                                      {at(0.0, 1.0), at(edge, 1.0, Vec3(v, 0, 0)), away(2)});
  EXPECT_LT(report.gain, 1e-9);
}

TEST_F(EnergyAuditTest, WhatAFarPartLosesExplainsNothing) {
  const double v = std::sqrt(2.0 * g * d);
  const EnergyReport report = between({at(0.0, 1.0), at(10.0, 1.0, Vec3(2 * v, 0, 0)), away(2)},
                                      {at(0.0, 1.0, Vec3(v, 0, 0)), at(10.0, 1.0), away(2)});
  EXPECT_NEAR(report.gain, 1.0, 0.01);
  EXPECT_EQ(report.part, 0);
}

// Blocks of 11 m/s pinched a card out at 140 m/s, and lost more energy than it won.
TEST_F(EnergyAuditTest, APartFasterThanWhatHitItWasThrown) {
  world.bodies[1].mass = 0.001;
  const auto thrown = [&](double speed) {
    return between({at(0.0, 1.0, Vec3(11, 0, 0)), at(edge, 1.0), away(2)},
                   {at(0.0, 1.0, Vec3(5, 0, 0)), at(edge, 1.0, Vec3(speed, 0, 0)), away(2)});
  };
  EXPECT_EQ(thrown(11.0).thrown.part, -1) << "as fast as what hit it";
  const EnergyReport report = thrown(140.0);
  EXPECT_LT(report.gain, 1e-9);
  EXPECT_NEAR(report.thrown.ratio, (140.0 - g * dt) / 11.0, 1e-9);
  EXPECT_EQ(report.thrown.part, 1);
  EXPECT_EQ(report.thrown.beside, 0);
  world.bodies[1].restitution = 1.0;
  EXPECT_NEAR(thrown(140.0).thrown.ratio, (140.0 - g * dt) / 22.0, 1e-9) << "what is elastic leaves twice as fast";
}

TEST_F(EnergyAuditTest, WhatFallsIsNotThrown) {
  EXPECT_EQ(
      between({at(0.0, 1.0), away(1), away(2)}, {at(0.0, 1.0, Vec3(0, 0, -g * dt)), away(1), away(2)}).thrown.part, -1);
}

TEST_F(EnergyAuditTest, AFlagNamesWhoWasThrownAndBesideWhom) {
  EnergyAudit audit(world);
  audit.enter(0, at(0.0, 1.0, Vec3(2, 0, 0)));
  audit.enter(1, at(edge, 1.0));
  audit.observe(dt, {at(0.0, 1.0), at(edge, 1.0, Vec3(8, 0, 0)), away(2)});
  const std::vector<Flag> flags = flags_of(audit.worst());
  ASSERT_EQ(flags.size(), 2u) << "it gained energy, too";
  EXPECT_EQ(flags[1].code, "part_thrown");
  EXPECT_NE(flags[1].text.find("part 1, beside part 0, left at 3.9"), std::string::npos) << flags[1].text;
}

// What a gain of one part in one interval cannot show: a slow rise, and one that comes after a loss of others.
TEST_F(EnergyAuditTest, ARiseOfAllTogetherIsMeasuredFromTheLeastBefore) {
  EnergyAudit audit(world);
  audit.enter(0, at(0.0, 1.0));
  audit.enter(1, at(edge, 1.0, Vec3(2, 0, 0)));
  audit.enter(2, away(2));
  audit.observe(dt, {at(0.0, 1.0), at(edge, 1.0), away(2)});  // an impact: 2 J are lost
  EXPECT_EQ(audit.worst_of_world().relative, 0.0);
  for (int k = 1; k <= 10; ++k)  // one rises by d / 100 an interval, and one stands where it is
    audit.observe((1 + k) * dt, {at(0.0, 1.0 + 0.01 * k * d), at(edge, 1.0), away(2)});
  EXPECT_NEAR(audit.worst_of_world().relative, 0.1, 1e-9) << "in m g d of the one that moved";
  EXPECT_NEAR(audit.worst_of_world().time, 11 * dt, 1e-12);
  audit.observe(12 * dt, {at(0.0, 1.0), at(edge, 1.0), away(2)});
  EXPECT_NEAR(audit.worst_of_world().relative, 0.1, 1e-9) << "the worst, not the last";
}

TEST_F(EnergyAuditTest, AllTogetherGainNothingFromWhatOneGivesAnother) {
  world.bodies[1].mass = 5e-4;
  EnergyAudit audit(world);
  audit.enter(0, at(0.0, 1.0, Vec3(0.1, 0, 0)));
  audit.enter(1, at(edge, 1.0));
  audit.enter(2, away(2));
  audit.observe(dt, {at(0.0, 1.0), at(edge, 1.0, Vec3(0.1 * std::sqrt(1000.0), 0, 0)), away(2)});
  EXPECT_EQ(audit.worst_of_world().relative, 0.0);
  audit.enter(1, at(edge, 3.0));  // put there by somebody else
  audit.observe(2 * dt, {at(0.0, 1.0), at(edge, 3.0), away(2)});
  EXPECT_EQ(audit.worst_of_world().relative, 0.0);
}

TEST_F(EnergyAuditTest, OfAHeapThatTremblesTogetherTheWholeIsTheUnit) {
  world.bodies.resize(100);
  for (BodyDef& body : world.bodies) body.mass = 0.5;
  EnergyAudit audit(world);
  std::vector<BodyState> before, after;
  for (int b = 0; b < 100; ++b) {
    before.push_back(at(b * edge, 1.0));
    after.push_back(at(b * edge, 1.0 + 1e-3 * d));
    audit.enter(static_cast<std::size_t>(b), before.back());
  }
  audit.observe(dt, after);
  EXPECT_NEAR(audit.worst_of_world().relative, 1e-3, 1e-9);
}

TEST_F(EnergyAuditTest, FixedPartsAndThoseThatNeverCameInAreLeftOut) {
  world.bodies[0].fixed = true;
  EnergyAudit audit(world);
  audit.enter(0, at(0.0, 1.0));
  audit.observe(dt, {at(0.0, 9.0), at(0.0, 9.0), {Pose::none(), {}}});
  EXPECT_EQ(audit.worst().part, -1);
  EXPECT_TRUE(flags_of(audit.worst()).empty());
}

TEST_F(EnergyAuditTest, EnteringAnewIsNoGainAndAFlagNamesThePart) {
  EnergyAudit audit(world);
  audit.enter(0, at(0.0, 1.0));
  audit.enter(0, at(0.0, 3.0));
  audit.observe(dt, {at(0.0, 3.0), away(1), away(2)});
  EXPECT_EQ(audit.worst().gain, 0.0);
  audit.observe(2 * dt, {at(0.0, 3.0 + 3.0 * d), away(1), away(2)});
  EXPECT_NEAR(audit.worst().gain, 3.0, 1e-9);
  ASSERT_EQ(flags_of(audit.worst()).size(), 1u);
  EXPECT_EQ(flags_of(audit.worst())[0].code, "energy_gained");
  EXPECT_NE(flags_of(audit.worst())[0].text.find("part 0 gained 3"), std::string::npos)
      << flags_of(audit.worst())[0].text;
}

}  // namespace
}  // namespace bin_scenes
