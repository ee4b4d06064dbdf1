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
    judge(scene, {request, models});
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
  ASSERT_EQ(report.reasons.size(), 2u);
  EXPECT_EQ(report.reasons[0], "penetration 1.2 % of part 0 and 1 is above accept.penetration 1 %");
  EXPECT_EQ(report.reasons[1], "penetration 5.8 % of part 2 and the bin is above accept.penetration 1 %");
  heap.request.accept.penetration = 0.02;
  EXPECT_EQ(heap.judged().reasons.size(), 1u);
}

TEST(Judge, OverlapWithTheBinIsCountedLikeThatOfPairs) {
  Heap heap;
  for (int i = 0; i < 4; ++i) heap.place(0.2 * i - 0.3, 0, 0.05 - 0.001 * i);  // 0, 1, 2, 3 mm into the floor
  const Report& report = heap.judged();
  EXPECT_NEAR(report.penetration.bin_median, 0.002, 1e-9);
  EXPECT_NEAR(report.penetration.bin_p95, 0.003, 1e-9);
  EXPECT_NEAR(report.penetration.bin_max, 0.003, 1e-9);
  EXPECT_EQ(report.penetration.bin_part, 3);
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

TEST(Judge, WithoutGravityNothingFalls) {
  Heap heap;
  heap.request.gravity.setZero();
  heap.place(0, 0, 0.05);
  heap.place(0.02, 0.03, 0.157).pose.orientation = Quat(Eigen::AngleAxisd(1.0, Vec3(1, 1, 1).normalized()));
  EXPECT_EQ(heap.judged().gap.max, 0.0);
  for (const PartQuality& part : part_quality(heap.scene, {heap.request, heap.models}))
    EXPECT_EQ(part.gap, std::numeric_limits<double>::infinity()) << part.id;
}

TEST(Judge, WhatHangsInTheAirIsAReason) {
  Heap heap;
  heap.place(0, 0, 0.05);
  heap.place(0.4, 0, 0.0520);  // 2 mm above the floor
  EXPECT_EQ(heap.judged().reasons,
            (std::vector<std::string>{"part 1 could fall by 1.2 % of its size, which is above accept.gap 0.5 %"}));
  heap.request.accept.gap = 0.02;
  EXPECT_TRUE(heap.judged().accepted);
}

TEST(Judge, OverlapHoldsFromBelowButNotFromTheSide) {
  Heap heap;
  heap.place(0, 0, 0.05);
  ScenePart& other = heap.place(0.02, 0.01, 0.1495);  // half a millimetre into the first
  EXPECT_NEAR(heap.judged().gap.max, 0.0, 1e-12);
  other.pose.position = {0.0999, 0.01, 0.12};  // beside it: the floor is 7 cm below
  EXPECT_NEAR(heap.judged().gap.max, 0.07, 1e-9);
  other.pose.position = {0.0999999, 0.01, 0.12};
  EXPECT_NEAR(heap.judged().gap.max, 0.07, 1e-9);
  other.pose.position = {0.4501, 0.01, 0.12};  // in the wall instead
  EXPECT_NEAR(heap.judged().gap.max, 0.07, 1e-9);
  heap.request.gravity = {9.81, 0, 0.1};  // which is now below, and holds it, so that it holds the other
  EXPECT_NEAR(heap.judged().gap.max, 0.3501 * std::hypot(1, 0.1 / 9.81), 1e-9);
}

TEST(Judge, SlotTooNarrowHoldsWhatIsInIt) {
  Heap heap;
  heap.models[0] = PartModel::from_mesh(test::channel(0.2, 1).mesh, "channel");
  heap.models.push_back(PartModel::from_mesh(test::bar({0.3, 0.3, 0.3}).mesh, "cube"));
  heap.request.bin.inner_size = {5, 5, 5};
  heap.request.parts.resize(2);
  const Quat upright(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));  // the slot, 0.2 to 0.8 along x, opens upwards
  heap.place(0, 0, 0).pose.orientation = upright;
  heap.place(0.3501, 0, 0.6).line = 1;  // 0.1 mm from one wall
  EXPECT_NEAR(heap.judged().gap.max, 0.25, 1e-9);
  heap.scene.parts[1].pose.position.x() = 0.3499;  // in that wall
  EXPECT_NEAR(heap.judged().gap.max, 0.25, 1e-9);
  heap.models[1] = PartModel::from_mesh(test::bar({0.6002, 0.3, 0.3}).mesh, "wide");
  heap.scene.parts[1].pose.position.x() = 0.5;  // in both
  EXPECT_NEAR(heap.judged().gap.max, 0.0, 1e-9);
}

// The rim holds at its edge what no corner of the part is above.
TEST(Judge, RimHoldsWhatLiesAcross) {
  Heap heap;
  heap.models[0] = PartModel::from_mesh(test::bar({0.4, 0.05, 0.02}).mesh, "bar");
  const double tilt = 0.2;
  ScenePart& bar = heap.place(0.5, 0, 1 + 0.01 / std::cos(tilt) + 0.003);
  bar.pose.orientation = Quat(Eigen::AngleAxisd(-tilt, Vec3::UnitY()));  // the end in the bin is the lower one
  EXPECT_NEAR(heap.judged().gap.max, 0.003, 1e-9);
  bar.pose.position.z() -= 0.0031;
  EXPECT_NEAR(heap.judged().gap.max, 0.0, 1e-9);
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
            (std::vector<std::string>{"part 1 escaped", "not at rest after 20 s: 1 part moving (part 2)"}));
  EXPECT_EQ(heap.scene.report.penetration.bin_max, 0.0) << "what is outside does not overlap the bin";
  heap.request.accept.escaped = true;
  heap.request.seconds = 20.0;
  EXPECT_TRUE(heap.judged().accepted);
}

/// The solver has let go of what escaped: others pass through it where it was last.
TEST(Judge, EscapedPartsNeitherOverlapNorHoldOthers) {
  Heap heap;
  heap.place(0, 0, 0.05);
  heap.place(0.7, 0, 0.3).state = PartState::escaped;
  heap.place(0.75, 0, 0.32).state = PartState::escaped;  // in the other one that escaped
  heap.place(0.02, 0, 0.04).state = PartState::escaped;  // in the resting one
  heap.place(0.3, 0, 0.16).state = PartState::resting;   // above one that escaped, which is no floor
  heap.place(0.3, 0, 0.06).state = PartState::escaped;
  heap.request.accept.escaped = true;
  EXPECT_EQ(heap.judged().penetration.pairs, 0u);
  EXPECT_NEAR(heap.judged().gap.max, 0.11, 1e-9);
  heap.scene.parts[4].pose.position.z() = 0.05;
  EXPECT_EQ(heap.judged().reasons, std::vector<std::string>());
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
