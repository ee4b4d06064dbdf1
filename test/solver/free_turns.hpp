/// Bodies that nothing touches turn as the closed forms say, however fast. Include in a test file and instantiate as
/// closed_forms.hpp.
#pragma once

#include "solver/closed_form_scenes.hpp"
#include "solver/fixture.hpp"

namespace bin_scenes::testing {

class FreeTurns : public SolverTest {};

inline void expect_exact(const FreeTurn& turn, double size) {
  EXPECT_LT(turn.momentum, 1e-4) << size << " m";
  EXPECT_LT(turn.energy, 1e-4) << size << " m";
  EXPECT_LT(turn.rate, 5e-4) << size << " m";
}

// The direction of the angular momentum was off by 0.1 to 1.2 %, depending on the step.
TEST_P(FreeTurns, OfADiscPrecessEvenly) {
  for (const double size : {0.005, 0.05, 0.3}) expect_exact(spin_freely(lab(), size), size);
}

// The direction of the angular momentum was off by 0.6 to 5.4 %, depending on the step.
TEST_P(FreeTurns, OfABoardAboutItsMiddleAxisTurnOverInTime) {
  for (const double size : {0.005, 0.05, 0.3}) expect_exact(turn_over_freely(lab(), size), size);
}

}  // namespace bin_scenes::testing
