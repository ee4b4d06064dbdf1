#include "solver/sphere_gl/arena.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::sphere_gl {
namespace {

/// A world in free flight has no planes: its region is empty, and goes without those of others.
TEST(Arena, AnEmptyRegionIsItsOwn) {
  Arena arena;
  const std::size_t full = arena.take(6), empty = arena.take(0);
  arena.give(empty);
  EXPECT_NE(arena.take(6), full);
}

TEST(Arena, RegionsLieApartAndGrowWhereNothingIsBehind) {
  Arena arena;
  const std::size_t a = arena.take(4), b = arena.take(4);
  EXPECT_EQ(b, a + 4);
  EXPECT_FALSE(arena.extend(a, 5));
  EXPECT_TRUE(arena.extend(b, 9));
  arena.give(a);
  EXPECT_EQ(arena.take(5), b + 9);
  EXPECT_EQ(arena.take(4), a);
  EXPECT_EQ(arena.size(), b + 14);
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
