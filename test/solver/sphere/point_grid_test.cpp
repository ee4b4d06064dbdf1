#include "solver/sphere/shapes/point_grid.hpp"
#include "bin_scenes/core/random.hpp"

#include <gtest/gtest.h>

#include <set>

namespace bin_scenes::sphere {
namespace {

std::set<std::size_t> within(const PointGrid& grid, const Vec3& place, double radius) {
  std::set<std::size_t> found;
  grid.any_within(place, radius, [&](std::size_t i) {
    EXPECT_TRUE(found.insert(i).second) << "visited twice";
    return false;
  });
  return found;
}

TEST(PointGrid, FindsWhatAPlainSearchFinds) {
  Random random(1, 0, Stream::probe);
  const auto place = [&](double reach) {
    return Vec3(reach * random.uniform(-1.0, 1.0), reach * random.uniform(-1.0, 1.0),
                reach * random.uniform(-1.0, 1.0));
  };
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i) points.push_back(place(0.1));
  points.push_back(points.front());
  for (const double reach : {0.0, 0.003, 0.05, 10.0}) {
    const PointGrid grid(points, reach);
    for (int i = 0; i < 50; ++i) {
      const Vec3 at = place(0.3);
      for (const double radius : {0.0, 0.01, 0.2, 5.0}) {
        std::set<std::size_t> near;
        for (std::size_t k = 0; k < points.size(); ++k)
          if ((points[k] - at).norm() <= radius) near.insert(k);
        EXPECT_EQ(within(grid, at, radius), near);
      }
      EXPECT_EQ(within(grid, points[7], 0.0), (std::set<std::size_t>{7}));
      EXPECT_EQ(within(grid, points[0], 0.0), (std::set<std::size_t>{0, 500}));
    }
  }
}

TEST(PointGrid, HoldsNoneOneAndFlatOnes) {
  EXPECT_TRUE(within(PointGrid({}, 0.1), Vec3::Zero(), 1e9).empty());
  EXPECT_EQ(within(PointGrid({Vec3(1, 2, 3)}, 0.0), Vec3(1, 2, 3), 0.0).size(), 1u);
  EXPECT_EQ(within(PointGrid({Vec3(0, 0, 1), Vec3(5, 0, 1), Vec3(9, 0, 1)}, 1.0), Vec3(4.5, 0, 1), 1.0).size(), 1u);
}

TEST(PointGrid, StopsAtTheFirst) {
  int visits = 0;
  const PointGrid grid({Vec3::Zero(), Vec3::Zero()}, 1.0);
  EXPECT_TRUE(grid.any_within(Vec3::Zero(), 1.0, [&](std::size_t) { return ++visits > 0; }));
  EXPECT_EQ(visits, 1);
}

}  // namespace
}  // namespace bin_scenes::sphere
