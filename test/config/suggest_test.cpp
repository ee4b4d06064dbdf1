#include "config/suggest.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::config {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("count", ""), 5u);
  EXPECT_EQ(edit_distance("count", "count"), 0u);
  EXPECT_EQ(edit_distance("cuont", "count"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Nearest, FindsTheClosestOrNothing) {
  EXPECT_EQ(nearest("fricton", {"restitution", "friction", "fixed"}), "friction");
  EXPECT_EQ(nearest("zzzzzzz", {"restitution", "friction", "fixed"}), "");
  EXPECT_EQ(nearest("word", {}), "");
  EXPECT_EQ(nearest("5", {"out", "x"}), "") << "nothing in common";
}

}  // namespace
}  // namespace bin_scenes::config
