#include "generate/proving.hpp"

#include "bin_scenes/core/error.hpp"
#include "grasp/finger_boxes.hpp"
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
  const std::vector<Sweep> checked = closed_shape(gripper, {width}, 0.0);
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

TEST(Proving, AFingerOfAMeshIsCoveredByBoxes) {
  // A finger 4 mm thick and 8 mm wide at its tip, and 10 mm thick and 16 mm wide above it.
  Gripper gripper;
  const double tip = 0.5 * gripper.pad_length;
  const auto box = [](const Vec3& lower, const Vec3& upper, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < 8; ++i)
      mesh.vertices.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                                 i & 4 ? upper.z() : lower.z());
    for (const Triangle& t : {Triangle{0, 2, 1}, Triangle{1, 2, 3}, Triangle{4, 5, 6}, Triangle{5, 7, 6},
                              Triangle{0, 1, 4}, Triangle{1, 5, 4}, Triangle{2, 6, 3}, Triangle{3, 6, 7},
                              Triangle{0, 4, 2}, Triangle{2, 4, 6}, Triangle{1, 3, 5}, Triangle{3, 7, 5}})
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  };
  Mesh mesh;
  box({0, -0.004, tip - 0.024}, {0.004, 0.004, tip}, mesh);
  box({0, -0.008, tip - 0.048}, {0.010, 0.008, tip - 0.024}, mesh);
  const std::vector<Aabb> boxes = boxes_around(mesh, gripper, "finger_mesh");
  ASSERT_LE(boxes.size(), 3u);
  double volume = 0.0;
  for (const Aabb& one : boxes) volume += one.size().prod();
  const double exact = 0.024 * (0.004 * 0.008 + 0.010 * 0.016);
  EXPECT_GE(volume, exact * (1.0 - 1e-9));
  EXPECT_LE(volume, exact + 0.003 * 0.010 * 0.016 * 1.01);  // one slice may belong to both
  gripper.finger_boxes = boxes;
  EXPECT_EQ(closed_shape(gripper, {0.02}, 0.0).size(), 2 * boxes.size() + 1);
  for (Vec3& v : mesh.vertices) v *= 1000.0;
  EXPECT_THROW(boxes_around(mesh, gripper, "finger_mesh"), Error);
}

}  // namespace
}  // namespace bin_scenes
