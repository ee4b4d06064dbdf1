#include "generate/proving.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

TEST(Proving, ChosenGraspsAreFreeAndSpreadFromTheBestToTheWorst) {
  std::vector<SceneGrasp> grasps(12);
  for (std::size_t i = 0; i < grasps.size(); ++i) grasps[i].score = 0.1 * static_cast<double>((i * 5) % 12);
  grasps[7].obstacle = SceneGrasp::Obstacle::closing;  // the one with the highest score, 1.1
  const auto scores = [&](std::size_t count) {
    std::vector<int> tenths;
    for (const std::size_t i : spread_over_scores(grasps, count))
      tenths.push_back(static_cast<int>(10.0 * grasps[i].score + 0.5));
    return tenths;
  };
  EXPECT_TRUE(scores(0).empty());
  EXPECT_EQ(scores(1), (std::vector<int>{10}));
  EXPECT_EQ(scores(3), (std::vector<int>{10, 5, 0}));
  EXPECT_EQ(scores(11), (std::vector<int>{10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0}));
  EXPECT_EQ(scores(40), scores(11));
}

}  // namespace
}  // namespace bin_scenes
