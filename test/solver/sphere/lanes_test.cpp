#include "solver/sphere/passes/lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes::sphere {
namespace {

// IEEE 754 leaves one answer. An estimate of the processor's own, refined, is off by a bit or two, and by others on the
// next maker's machine: the same request would give other scenes there.
TEST(Lanes, SquareRootsAreThoseOfSingleFloats) {
  float x = 1e-12f;
  for (int round = 0; round < 4000; ++round) {
    Lanes squares{};
    for (int lane = 0; lane < lane_count; ++lane) squares[lane] = x *= 1.00171f;
    const Lanes roots = sqrt(squares);
    for (int lane = 0; lane < lane_count; ++lane) ASSERT_EQ(roots[lane], std::sqrt(squares[lane])) << squares[lane];
  }
}

}  // namespace
}  // namespace bin_scenes::sphere
