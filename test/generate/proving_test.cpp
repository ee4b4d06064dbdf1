#include "generate/proving.hpp"

#include "grasp/gripper_shape.hpp"
#include "pour/gripper_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

// What is simulated fills the room that collisions are found with.
TEST(Proving, FingersAndPalmAreTheBodiesThatCollisionsAreFoundWith) {
  const Gripper gripper;
  const double width = 0.02;
  std::vector<Aabb> simulated;
  for (const GripperBody& body : bodies_of(gripper)) {
    Aabb box;
    for (const Vec3& v : body.model->mesh().vertices) {
      const double side = simulated.size() == 0 ? -0.5 : simulated.size() == 1 ? 0.5 : 0.0;
      box.extend(body.pose * v + Vec3(side * width, 0, 0));
    }
    simulated.push_back(box);
  }
  const std::vector<Sweep> checked = closed_shape(gripper, width, 0.0);
  ASSERT_EQ(simulated.size(), checked.size());
  for (const Sweep& sweep : checked) {
    double least = 1.0;
    for (const Aabb& box : simulated)
      least = std::min(least, (box.lower - sweep.bounds().lower).norm() + (box.upper - sweep.bounds().upper).norm());
    EXPECT_LT(least, 1e-9);
  }
}

TEST(Proving, RingsAreClosedAndEndAtTheCupsMouth) {
  Gripper cup;
  cup.type = Gripper::Type::suction;
  const GripperBody ring = bodies_of(cup).front();
  EXPECT_TRUE(ring.model->load_report().flags.empty());
  const double inner = 0.7 * cup.radius, area = 0.5 * 32 * std::sin(2.0 * M_PI / 32);  // of a polygon of radius 1
  EXPECT_NEAR(ring.model->mass().volume / (area * (cup.radius * cup.radius - inner * inner) * 0.03), 1.0, 1e-6);
  EXPECT_NEAR(ring.model->mesh().bounds().upper.z(), 0.0, 1e-12);
}

}  // namespace
}  // namespace bin_scenes
