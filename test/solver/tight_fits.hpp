/// Parts that fit into each other with little room, for every solver: instantiate as closed_forms.hpp.
#pragma once

#include "solver/fixture.hpp"
#include "solver/tight_scenes.hpp"

namespace bin_scenes::testing {

class TightFits : public SolverTest {};

// The distance field of the pit bends over two cells beside its edges, where the corner stood off by 6 to 14 mm of
// 1,700, turned by up to 0.015 rad, and was thrown up by 0.008 m g d.
TEST_P(TightFits, ACornerDropsIntoItsPit) {
  for (const double drop : {0.0, 0.3})
    for (const double gap : {0.0005, 0.002, 0.005, 0.015, 0.025})
      for (const double friction : {0.0, 0.5}) {
        SCOPED_TRACE("drop " + std::to_string(drop) + ", gap " + std::to_string(gap) + ", friction " +
                     std::to_string(friction));
        const Fit fit = corner_into_pit(lab(), gap, drop, friction);
        EXPECT_LT(fit.off.norm(), 6e-4);
        EXPECT_LT(fit.turned, 1e-3);
        EXPECT_LT(fit.risen, 3e-3);
      }
}

// With 0.2 % it stood on the mouth, or slid off the block where nothing rubs.
TEST_P(TightFits, APegEntersItsHole) {
  for (const std::uint32_t sides : {4u, 6u})
    for (const double play : {0.002, 0.005, 0.02})
      for (const double friction : {0.0, 0.5}) {
        SCOPED_TRACE(std::to_string(sides) + " sides, play " + std::to_string(play) + ", friction " +
                     std::to_string(friction));
        EXPECT_LT(std::abs(peg_into_hole(lab(), sides, play, friction).off.z()), 4e-3);
      }
}

}  // namespace bin_scenes::testing
