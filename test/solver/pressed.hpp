/// What presses others apart, or is pressed, gives nothing away, however short the steps: instantiate as
/// closed_forms.hpp, with a case for each step.
#pragma once

#include "solver/fixture.hpp"
#include "solver/pressed_scenes.hpp"

namespace bin_scenes::testing {

class Pressing : public SolverTest {};

// Once it gained 0.4 % by default and 7 % in an eighth of the step, and hopped.
TEST_P(Pressing, APointBetweenOthersGainsNothing) {
  for (const Point point : {Point::wedge, Point::spike})
    for (const bool stands : {true, false})
      for (const double size : {0.02, 0.2, 2.0})
        for (const double slim : {0.1, 0.6})
          for (const double gap : {0.0, 1e-3})
            for (const auto& [friction, load] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.5, 20.0}}) {
              const Pressed pressed = press_between(lab(), {point, size, slim, friction, gap, load, stands});
              EXPECT_LT(pressed.risen, 2e-3)
                  << static_cast<int>(point) << ", " << size << " m, " << slim << ", gap " << gap << ", friction "
                  << friction << ", " << load << " kg, below " << (stands ? "fixed" : "free");
              EXPECT_LT(pressed.hop, 1e-3);
            }
}

// Tips sank in by up to 5 % of the diagonal before contacts were found, edges beyond the other tip pressed back, and
// what was pushed out stayed as velocity: 0.1, 0.3, 4 and 52 % in ever shorter steps.
TEST_P(Pressing, ATipOnATipGainsNothing) {
  for (const std::uint32_t sides : {4u, 8u})
    for (const double size : {0.005, 0.05, 0.3})
      for (const double slim : {0.3, 0.5, 0.8})
        for (const auto& [aside, drop] : {std::pair{1e-4, 0.0}, {1e-3, 0.0}, {1e-3, 0.02}})
          EXPECT_LT(tip_on_tip(lab(), {sides, size, slim, aside, drop}), 1e-3)
              << sides << " sides, " << size << " m, " << slim << ", " << aside << " aside, from " << drop;
}

// A slimmer one buckles without friction.
TEST_P(Pressing, SidesOfAGroovePressAsItsAngleSays) {
  for (const double slim : {0.15, 0.3, 0.6}) {
    const double expected = std::hypot(1.0, slim) / (2.0 * slim);
    EXPECT_NEAR(pressed_in_groove(lab(), slim) / expected, 1.0, 0.01) << slim;
  }
}

// An edge that caught its tip took 40 %.
TEST_P(Pressing, ASpikeSlidesOverARim) {
  for (const double size : {0.02, 0.2, 2.0}) {
    const Slid slid = slide_over_rim(lab(), size);
    EXPECT_LT(slid.lost, 0.02) << size << " m";
    EXPECT_GT(slid.lost, -GetParam().rounding) << size << " m";
    EXPECT_GT(slid.spin, 0.1) << size << " m: it has touched nothing";
  }
}

// It got 56 to 104 % back.
TEST_P(Pressing, AChainThatComesToItsEndGivesNothingBack) {
  for (const int links : {8, 16, 32, 64}) EXPECT_LT(given_back_by_a_chain(lab(), links, 0.8), 0.02) << links;
}

}  // namespace bin_scenes::testing
