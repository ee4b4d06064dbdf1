/// Closed forms every solver must reproduce with its default settings. Tolerances are those of the project's measures.
/// Include in a test file and instantiate: INSTANTIATE_TEST_SUITE_P(Bullet, ClosedForms, ::testing::Values(...)).
#pragma once

#include "solver/closed_form_scenes.hpp"
#include "solver/fixture.hpp"

namespace bin_scenes::testing {

class ClosedForms : public SolverTest {};
class Counted : public SolverTest {};
class Stacks : public SolverTest {};  ///< long

TEST_P(ClosedForms, FreeFallIsAParabola) {
  const Fall error = free_fall(lab());
  EXPECT_LT(error.distance, 1e-4);
  EXPECT_LT(error.speed, 1e-4);
}

TEST_P(ClosedForms, BounceReachesRestitutionSquaredOfTheHeight) {
  for (const double drop : {0.3, 0.437, 0.6})
    EXPECT_NEAR(bounce(lab(), drop, 0.9), 0.81, 0.0081) << "dropped from " << drop;
}

TEST_P(ClosedForms, ContactForcesCarryWhatLiesOnThem) {
  const Carried error = carry(lab());
  EXPECT_LT(error.force, 1e-3);
  EXPECT_LT(error.moment, 1e-3);
}

TEST_P(ClosedForms, SlidingDistanceFollowsFromFriction) {
  const Slide error = slide(lab());
  EXPECT_LT(error.distance, 0.005);
  EXPECT_LT(error.aside, 0.005);
  EXPECT_LT(error.speed, 1e-3);
}

TEST_P(ClosedForms, SticksBelowTheFrictionAngleAndSlipsAbove) {
  const double threshold = std::atan(0.5), half_degree = 0.5 * M_PI / 180.0;
  for (const double heading : {0.0, 0.4, 0.25 * M_PI}) {
    EXPECT_LT(slip(lab(), threshold - half_degree, heading), 1e-3) << heading;
    EXPECT_GT(slip(lab(), threshold + half_degree, heading), 0.02) << heading;
  }
}

TEST_P(ClosedForms, SphereRollsDownASlope) {
  EXPECT_LT(roll(lab()), 0.002);
}

TEST_P(ClosedForms, CollisionKeepsMomentumAndNeverGainsEnergy) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    const Collision change = collide(lab(), restitution);
    EXPECT_GT(change.push, 0.1) << "they did not meet";
    EXPECT_LT(change.momentum, 1e-5) << restitution;
    EXPECT_LT(change.spin, 0.02) << restitution;
    EXPECT_LT(change.energy, 1.0 + 1e-5) << restitution;
  }
}

TEST_P(ClosedForms, FreeTumblingKeepsEnergyAndAngularMomentum) {
  const Tumble result = tumble(lab());
  EXPECT_LT(result.turned, -0.9) << "it never turned over";
  EXPECT_LT(result.highest, 1.0 + GetParam().rounding);
  EXPECT_GT(result.lowest, 1.0 - 1e-3);
  EXPECT_LT(result.spin, 1e-3);
}

// Turned as well: faces then coincide only to rounding, and Bullet's patches have more corners than a manifold holds.
TEST_P(Stacks, OfTenDriftLessThanAThousandthInThirtySeconds) {
  for (const double heading : {0.0, 0.3, 0.7}) EXPECT_LT(stack_drift(lab(), 30.0, heading), 1e-3) << heading;
}

TEST_P(Counted, CountersTellFreeFallFromContactAndSleep) {
  Lab fall = lab();
  fall.place(box(Vec3::Constant(0.04)), Vec3(0, 0, 0.07));
  const auto count = [&](const char* name) { return fall.solver().profile().counters.at(name); };
  fall.simulate(0.05);  // it falls by 12 mm of 50 mm
  EXPECT_EQ(count("body_steps_in_free_fall"), count("steps"));
  EXPECT_EQ(count("contacts"), 0u);
  fall.simulate(1.95);
  EXPECT_GT(count("contacts"), 0u);
  EXPECT_GT(count("pairs"), 0u);
  EXPECT_GT(count("body_steps_asleep"), 0u);
  EXPECT_LT(count("body_steps_in_free_fall") + count("body_steps_asleep"), count("steps"));
}

TEST_P(ClosedForms, ManyContactsAtOnceDoNotMultiplyTheImpulse) {
  const Rods speeds = meet_along_rods(lab());
  EXPECT_NEAR(speeds.first, 0.0, 0.01);
  EXPECT_NEAR(speeds.second, 1.0, 0.01);
}

}  // namespace bin_scenes::testing
