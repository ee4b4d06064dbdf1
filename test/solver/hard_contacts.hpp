/// Contacts that are hard to solve, for every solver: instantiate as closed_forms.hpp.
#pragma once

#include "solver/fixture.hpp"
#include "solver/hard_contact_scenes.hpp"

namespace bin_scenes::testing {

class HardContacts : public SolverTest {};

// Single precision alone is off by 0.2 m in its place and 0.4 m/s in its speed.
TEST_P(HardContacts, AThousandMetresASecondAreAKilometre) {
  const Fall error = long_flight(lab());
  EXPECT_LT(error.distance, 1e-6);
  EXPECT_LT(error.speed, 1e-6);
}

// With the speed that a sub-step ends with it stops 0.6 % too early.
TEST_P(HardContacts, SlidingDistanceFollowsFromGreatFriction) {
  const Slide error = slide(lab(), 0.5, 0.5);
  EXPECT_LT(error.distance, 1.5e-3);
  EXPECT_LT(error.aside, 1e-3);
  EXPECT_LT(error.speed, 1e-3);
}

// Struck at levers of half way through the step, 49 of 60 pairs change it by more than 0.2 %, one by 1.1 %. Bullet
// changes it by up to 0.6 %.
TEST_P(HardContacts, AnImpactKeepsTheAngularMomentum) {
  const double most = GetParam().name == "bullet" ? 7e-3 : 3e-3;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const double change = spin_gained_in_an_impact(lab(), seed);
    EXPECT_LT(change, most) << seed;
    sum += change;
  }
  EXPECT_LT(sum / 60.0, 1.5e-3);
}

// The last one falls at 4.9 m/s. When the impulse of an impact lived on as a force, the pile threw it back at 0.54 to
// 0.67 m/s and fell over, with any number of sub-steps; when few sweeps left an impact unshared, at 0.28.
TEST_P(HardContacts, CubesThatFallOnEachOtherDoNotRebound) {
  const Rebound pile = pile_up_cubes(lab(), 5);
  EXPECT_LT(pile.speed, 0.05);
  EXPECT_LT(pile.aside, 0.4);
  EXPECT_GT(pile.height, 0.95);
}

TEST_P(HardContacts, ACubeDoesNotReboundFromATenthOfItsMass) {
  const Rebound heavy = strike_light_cube(lab(), 10.0);
  EXPECT_LT(heavy.speed, 0.3);
  EXPECT_LT(heavy.aside, 0.15);
  EXPECT_GT(heavy.height, 0.95);
}

}  // namespace bin_scenes::testing
