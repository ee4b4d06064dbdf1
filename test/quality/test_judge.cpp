#include "bin_scenes/quality/quality.hpp"

#include "quality/pieces.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

/// Cubes of 10 cm in a bin of 1 m.
struct Heap {
  Request request;
  Scene scene;
  std::vector<PartModelPtr> models = {PartModel::from_mesh(test::bar({0.1, 0.1, 0.1}).mesh, "cube")};
  const double diagonal = 0.1 * std::sqrt(3.0);

  Heap() {
    request.bin.inner_size = {1, 1, 1};
    request.parts.resize(1);
    scene.report.at_rest = true;
  }
  ScenePart& place(double x, double y, double z) {
    ScenePart part;
    part.id = static_cast<int>(scene.parts.size());
    part.pose.position = {x, y, z};
    part.state = PartState::resting;
    scene.parts.push_back(part);
    return scene.parts.back();
  }
  const Report& judged() {
    judge(scene, request, models);
    return scene.report;
  }
};

TEST(Judge, PartsAtRestApartFromEachOtherAreAccepted) {
  Heap heap;
  heap.place(0, 0, 0.05);
  heap.place(0.3, 0, 0.05);
  const Report& report = heap.judged();
  EXPECT_TRUE(report.accepted);
  EXPECT_EQ(report.penetration.pairs, 0u);
  EXPECT_EQ(report.penetration.pair[0], -1);
  EXPECT_EQ(report.penetration.bin_max, 0.0);
  EXPECT_NEAR(report.gap.max, 0.0, 1e-12);
}

TEST(Judge, OverlapIsFoundAndTooMuchOfItNamed) {
  Heap heap;
  heap.place(0, 0, 0.05);
  heap.place(0.098, 0.01, 0.05);  // 2 mm into part 0
  heap.place(-0.3, 0, 0.04);      // 1 cm into the floor
  const Report& report = heap.judged();
  EXPECT_EQ(report.penetration.pairs, 1u);
  EXPECT_NEAR(report.penetration.max, 0.002, 1e-9);
  EXPECT_NEAR(report.penetration.max_relative, 0.002 / heap.diagonal, 1e-9);
  EXPECT_EQ(report.penetration.pair, (std::array<int, 2>{0, 1}));
  EXPECT_NEAR(report.penetration.bin_max, 0.01, 1e-9);
  EXPECT_EQ(report.penetration.bin_part, 2);
  EXPECT_FALSE(report.accepted);
  ASSERT_EQ(report.reasons.size(), 1u);
  EXPECT_EQ(report.reasons[0], "penetration 5.8 % of part 2 and the bin is above accept.penetration 2 %");
  heap.request.accept.penetration = 0.01;
  EXPECT_EQ(heap.judged().reasons[0], "penetration 1.2 % of part 0 and 1 is above accept.penetration 1 %");
}

TEST(Judge, GapIsTheFreeWayDown) {
  Heap heap;
  heap.place(0, 0, 0.05);
  heap.place(0.02, 0.03, 0.157);  // 7 mm above part 0
  heap.place(0.4, 0, 0.062);      // 12 mm above the floor
  EXPECT_NEAR(heap.judged().gap.max, 0.012, 1e-9);
  EXPECT_NEAR(heap.judged().gap.median, 0.007, 1e-9);
  heap.scene.parts[2].state = PartState::moving;  // no claim to rest
  EXPECT_NEAR(heap.judged().gap.max, 0.007, 1e-9);
}

TEST(Judge, EscapedAndMovingPartsAreReasons) {
  Heap heap;
  heap.place(0, 0, 0.05);
  heap.place(3, 0, -2).state = PartState::escaped;
  heap.place(0.3, 0, 0.05).state = PartState::moving;
  heap.place(0, 0, 0).state = PartState::not_poured;
  heap.scene.report.escaped = {1};
  heap.scene.report.at_rest = false;
  heap.scene.report.simulated_s = 20.0;
  EXPECT_EQ(heap.judged().reasons,
            (std::vector<std::string>{"part 1 escaped", "not at rest after 20 s: 1 part moving"}));
  EXPECT_EQ(heap.scene.report.penetration.bin_max, 0.0) << "what is outside does not overlap the bin";
  heap.request.accept.escaped = true;
  heap.request.seconds = 20.0;
  EXPECT_TRUE(heap.judged().accepted);
}

TEST(Judge, ASceneInWhichNothingWasPouredIsSetApart) {
  Heap heap;
  heap.place(0, 0, 0.05).state = PartState::fixed;
  EXPECT_TRUE(heap.judged().accepted) << "an obstacle alone is what was asked for";
  for (int i = 0; i < 2; ++i) {
    ScenePart& part = heap.place(0, 0, 0);
    part.state = PartState::not_poured;
    part.pose = Pose::none();
  }
  heap.scene.report.not_poured = {1, 2};
  EXPECT_EQ(heap.judged().reasons, std::vector<std::string>{"nothing was poured: no part found room below the rim"});
  heap.request.seconds = 1.0;
  EXPECT_FALSE(heap.judged().accepted);
  heap.place(0.3, 0, 0.05);
  EXPECT_TRUE(heap.judged().accepted);
}

TEST(Drift, MoveOfTheCentreAndTurn) {
  Heap before, after;
  before.place(0, 0, 0.05);
  before.place(0.3, 0, 0.05);
  after.place(0, 0, 0.05);
  after.place(0.3, 0.004, 0.05).pose.orientation = Quat(Eigen::AngleAxisd(0.2, Vec3::UnitZ()));
  const DriftReport report = drift(before.scene, after.scene, before.models);
  EXPECT_TRUE(report.measured);
  EXPECT_NEAR(report.max, 0.004, 1e-12);
  EXPECT_NEAR(report.turn_p95, 0.2, 1e-12);
}

}  // namespace
}  // namespace bin_scenes
