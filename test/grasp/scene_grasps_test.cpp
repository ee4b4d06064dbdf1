/// Grasps of small scenes whose orders of removal, loads and slips are known.
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"
#include "stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace bin_scenes {
namespace {

using test::cup, test::free_of, test::pick_of, test::Stage, test::two_fingers;

TEST(SceneGrasps, StackOfPlatesComesOutFromTheTop) {
  Stage stage({cup()});
  const std::size_t plate = stage.add(test::box_mesh({0.08, 0.06, 0.005}));
  const int heights[] = {2, 0, 4, 1, 3};  // of ids 0..4
  for (const int height : heights) stage.put(plate, {0, 0, 0.0025 + 0.005 * height});
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.removal_order, (std::vector<int>{2, 4, 0, 3, 1}));
  EXPECT_EQ(pick_of(found, 2).depth, 0);
  EXPECT_EQ(pick_of(found, 1).depth, 4);
  EXPECT_EQ(pick_of(found, 0).blocked_by, (std::vector<int>{2, 4}));
  EXPECT_GT(free_of(found, 2), 0u);
  for (const int below : {0, 1, 3, 4}) EXPECT_EQ(free_of(found, below), 0u);
  for (const SceneGrasp& grasp : found.grasps) {
    if (grasp.part != 0) continue;
    EXPECT_EQ(reason_of(grasp, pick_of(found, 0)), "lift blocked by part 2, part 4");
  }
}

TEST(SceneGrasps, PartsSideBySideDoNotBlockEachOther) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0.04 - 1e-6, 0, 0.02});  // overlaps a little, as parts of heaps do
  stage.put(cube, {0.1, 0, 0.02 - 1e-6});   // and the floor
  const SceneGrasps found = stage.find();
  for (const PartPick& pick : found.parts) EXPECT_TRUE(pick.blocked_by.empty()) << pick.id;
  EXPECT_EQ(found.removal_order.size(), 3u);
  // The touching faces of the first two leave no room for a finger.
  for (const SceneGrasp& grasp : found.grasps) {
    const Vec3 closing = grasp.pose.orientation * Vec3::UnitX();
    if (grasp.part > 1 || !grasp.free()) continue;
    EXPECT_LT(std::abs(closing.x()), 0.5);
  }
  EXPECT_GT(free_of(found, 0), 0u);
}

TEST(SceneGrasps, WhatIsOnlyGrazedDoesNotBlock) {
  for (const double over : {2e-5, 5e-4}) {  // m, by which the upper cube stands over the lower one's rim
    Stage stage({two_fingers()});
    const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
    stage.put(cube, {0, 0, 0.02});
    stage.put(cube, {0.04 - over, 0, 0.07});
    const std::vector<int> expected = over < 1e-4 ? std::vector<int>{} : std::vector<int>{1};
    EXPECT_EQ(pick_of(stage.find(), 0).blocked_by, expected) << over;
  }
}

TEST(SceneGrasps, HookedPartsLeaveTogether) {
  // Two links of a chain, one through the other, and a link that lies below the first one.
  Stage stage({two_fingers()});
  const std::size_t ring = stage.add(test::torus_mesh(0.02, 0.004, 40, 16));
  stage.put(ring, {0, 0, 0.03});
  stage.put(ring, {0.02, 0, 0.03}, Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())));
  stage.put(ring, {-0.1, 0, 0.004});
  stage.put(ring, {-0.02, 0, 0.004});
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.removal_order, (std::vector<int>{2, 1, 0, 3}));
  ASSERT_EQ(found.held_sets.size(), 1u);
  EXPECT_EQ(found.held_sets[0].ids, (std::vector<int>{1, 0}));
  EXPECT_GT(found.held_sets[0].overlap, 1e-5);
  EXPECT_EQ(pick_of(found, 0).depth, 0);
  EXPECT_EQ(pick_of(found, 3).depth, 1);
  EXPECT_EQ(pick_of(found, 0).blocked_by, (std::vector<int>{1}));
  EXPECT_EQ(pick_of(found, 1).blocked_by, (std::vector<int>{0}));
}

TEST(SceneGrasps, ChainsOfManyLinksAreTakenApartWhereTheyCoverEachOtherLeast) {
  // Five upright links; each one passes through the next, which is turned by a quarter. The last one passes less
  // deeply.
  Stage stage({two_fingers()});
  const std::size_t ring = stage.add(test::torus_mesh(0.02, 0.004, 40, 16));
  for (int i = 0; i < 5; ++i)
    stage.put(ring, {0.025 * i, 0, 0.03},
              i % 2 == 0 ? Quat::Identity() : Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())));
  const SceneGrasps found = stage.find();
  ASSERT_EQ(found.held_sets.size(), 1u);
  const SceneGrasps::HeldSet& held = found.held_sets[0];
  EXPECT_EQ(held.ids.size(), 5u);
  EXPECT_EQ(found.removal_order, held.ids);
  // An inner link is covered by two others, so that an end leaves first, and then the chain grows shorter from its
  // ends.
  ASSERT_GE(held.forced.size(), 1u);
  EXPECT_TRUE(held.forced[0].part == 0 || held.forced[0].part == 4) << held.forced[0].part;
  EXPECT_EQ(held.forced[0].part, held.ids[0]);
  std::set<int> gone;
  for (const int id : held.ids) {
    double covered = 0.0;
    const PartPick& pick = pick_of(found, id);
    for (std::size_t i = 0; i < pick.blocked_by.size(); ++i)
      if (!gone.count(pick.blocked_by[i])) covered += pick.blocked_areas[i];
    const auto forced =
        std::find_if(held.forced.begin(), held.forced.end(), [&](auto& lift) { return lift.part == id; });
    EXPECT_EQ(forced != held.forced.end(), covered > 0.0) << id;
    if (forced != held.forced.end()) {
      EXPECT_EQ(forced->overlap, covered) << id;
    }
    gone.insert(id);
  }
  EXPECT_LT(held.forced.size(), 5u);  // the last link is free
}

TEST(SceneGrasps, OverlapIsAnAreaAndAMoveThatFreesThePart) {
  // A cube stands 3 mm over the rim of another one, over half of its length.
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0.037, 0.02, 0.07});
  const SceneGrasps found = stage.find();
  const PartPick& pick = pick_of(found, 0);
  const double cell = 0.04 * std::sqrt(3.0) / 64.0;
  EXPECT_NEAR(pick.overlap.area, 0.003 * 0.02, cell * 0.023);
  EXPECT_NEAR(pick.overlap.share, 0.003 * 0.02 / (0.04 * 0.04), cell * 0.023 / (0.04 * 0.04));
  EXPECT_NEAR(pick.overlap.move.norm(), 0.003, 2.0 * cell);
  EXPECT_LT(pick.overlap.move.normalized().x(), -0.9);
  EXPECT_EQ(pick.blocked_areas.size(), 1u);
  EXPECT_EQ(pick_of(found, 1).overlap.area, 0.0);
}

TEST(SceneGrasps, WhatSomethingFixedCoversComesLast) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0.02, 0, 0.07});
  stage.put(cube, {0.1, 0, 0.02});
  stage.scene.parts[1].state = PartState::fixed;
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.removal_order, (std::vector<int>{2, 0}));
  EXPECT_EQ(pick_of(found, 0).depth, -1);
  EXPECT_TRUE(found.held_sets.empty());
}

TEST(SceneGrasps, LoadAndPullComeFromContactForces) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0, 0, 0.06});
  const double weight = 9.81 * 1000.0 * 0.04 * 0.04 * 0.04;
  stage.scene.contacts.push_back({0, 1, Vec3(0, 0, 0.04), Vec3::UnitZ(), Vec3(0, 0, weight)});
  stage.scene.contacts.push_back({0, -1, Vec3::Zero(), -Vec3::UnitZ(), Vec3(0, 0, -2.0 * weight)});
  stage.scene.contacts.push_back({1, -1, Vec3(0.02, 0, 0.06), Vec3::UnitX(), Vec3(3.0, 0, 0)});  // a wall squeezes
  const SceneGrasps found = stage.find();
  EXPECT_NEAR(pick_of(found, 0).load, weight, 1e-12);
  EXPECT_NEAR(pick_of(found, 1).load, 0.0, 1e-12);
  // To where their lowest points pass the rim of the bin.
  EXPECT_LT((pick_of(found, 0).lift - Vec3(0, 0, 0.10)).norm(), 1e-9);
  EXPECT_LT((pick_of(found, 1).lift - Vec3(0, 0, 0.06)).norm(), 1e-9);
  // The upper one: its weight, and friction sqrt(0.5 * 0.5) of the wall. The lower one: both weights, and the friction
  // with which the upper one presses on it.
  EXPECT_NEAR(pick_of(found, 1).pull, weight + 0.5 * 3.0, 1e-9);
  EXPECT_NEAR(pick_of(found, 0).pull, 2.0 * weight + 0.5 * weight, 1e-9);
}

TEST(SceneGrasps, FrictionAtASideIsLoadButNoPartThatLiesOnIt) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0.04, 0, 0.02});
  const double weight = 9.81 * 1000.0 * 0.04 * 0.04 * 0.04;
  stage.scene.contacts.push_back({0, 1, Vec3(0.02, 0, 0.02), Vec3::UnitX(), Vec3(0.8, 0, 0.4 * weight)});
  const SceneGrasps found = stage.find();
  EXPECT_NEAR(pick_of(found, 0).load, 0.4 * weight, 1e-12);
  EXPECT_TRUE(pick_of(found, 0).blocked_by.empty());
  EXPECT_TRUE(pick_of(found, 1).blocked_by.empty());
}

TEST(SceneGrasps, WhatIsTooHeavySlips) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  // Both pads hold 2 * 0.5 * 60 N: 5.08 kg through the centre of the cube, lifted with 2 m/s2.
  const auto free_with = [&](double mass) {
    stage.loaded.request.parts[0].mass = mass;
    stage.loaded.request.parts[0].density.reset();
    return free_of(stage.find(), 0);
  };
  EXPECT_GT(free_with(1.0), 0u);
  EXPECT_EQ(free_with(1.01 * 60.0 / 11.81), 0u);
}

TEST(SceneGrasps, TiltIsMeasuredAgainstGravity) {
  Gripper gripper = cup();
  gripper.tilt = 0.3;
  Stage stage({gripper});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02}, Quat(Eigen::AngleAxisd(0.29, Vec3::UnitX())));
  EXPECT_GT(stage.find().grasps.size(), 0u);
  stage.scene.parts[0].pose.orientation = Quat(Eigen::AngleAxisd(0.31, Vec3::UnitX()));
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.grasps.size(), 0u);
  EXPECT_EQ(found.parts[0].tilted, found.found[0].placed);
}

TEST(SceneGrasps, CamerasSeeTheContactsThatFaceThem) {
  Stage stage({cup(), two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.loaded.request.sensors.emplace_back();
  stage.scene.sensors = resolved_sensors(stage.loaded);
  const std::vector<RangeImage> images = SensorRig().render(stage.scene, stage.loaded);
  std::size_t cups = 0;
  for (const SceneGrasp& grasp : stage.find(images).grasps) {
    ASSERT_EQ(grasp.visible.size(), 1u);
    if (grasp.gripper == 1) {  // sides of the cube, under a camera right above it
      EXPECT_LT(grasp.visible[0], 0.35);
      continue;
    }
    ++cups;
    EXPECT_EQ(grasp.visible[0], 1.0);
    EXPECT_EQ(grasp.measured[0], 1.0);
  }
  EXPECT_GT(cups, 5u);
}

TEST(SceneGrasps, NoGraspAtAllSaysWhy) {
  Gripper wide = cup();
  wide.radius = 0.03;
  Stage stage({wide});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.loaded.request.parts[cube].model = "cube.stl";
  stage.put(cube, {0, 0, 0.02});
  const auto flags = flags_of(stage.find(), stage.loaded.request);
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].code, "no_grasp");
  EXPECT_NE(flags[0].text.find("5000 where the ring leaves the part"), std::string::npos) << flags[0].text;
}

TEST(SceneGrasps, APalmThatCannotFollowIsTold) {
  Gripper broad = cup();
  broad.palm = {0.31, 0.32, 0.1};
  broad.finger_depth = 0.05;
  Stage stage({broad});
  Request& request = stage.loaded.request;
  request.bin.kind = Bin::Kind::box;
  const auto told = [&](const Vec3& room) {
    request.bin.inner_size = room;
    return flags_of({}, request);
  };
  const auto flags = told({0.4, 0.3, 0.2});
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].code, "palm_too_wide");
  EXPECT_NE(flags[0].text.find("no deeper than 50 mm below the rim"), std::string::npos) << flags[0].text;
  EXPECT_TRUE(told({0.4, 0.3, 0.05}).empty());   // its fingers reach the floor
  EXPECT_TRUE(told({0.4, 0.315, 0.2}).empty());  // it goes in, turned
}

TEST(SceneGrasps, SlightlyCoveredPartsAreGrasped) {
  // A plate of 40 mm, covered by another one by 1, 2 or 4 of its 40 mm.
  for (const double over : {0.001, 0.002, 0.004}) {
    Stage stage({two_fingers()});
    const std::size_t plate = stage.add(test::box_mesh({0.04, 0.04, 0.01}));
    stage.put(plate, Vec3(0, 0, 0.005));
    stage.put(plate, Vec3(0.04 - over, 0, 0.0151));
    stage.loaded.request.slight_overlap = 0.06;
    const SceneGrasps found = stage.find();
    const PartPick& pick = pick_of(found, 0);
    EXPECT_EQ(pick.blocked_by, (std::vector<int>{1}));
    EXPECT_NEAR(pick.overlap.share, over / 0.04, 0.02);
    EXPECT_EQ(pick.slight, over < 0.003) << over;
    EXPECT_EQ(free_of(found, 0) > 0, over < 0.003) << over;
    EXPECT_EQ(pick.depth, 1);
    stage.loaded.request.slight_overlap = 0.0;
    EXPECT_EQ(free_of(stage.find(), 0), 0u);
  }
}

TEST(SceneGrasps, LiftsLeanAwayFromWhatIsInTheWay) {
  // A fixed shelf over a third of a block: free to leave at 45 degrees, away from the shelf.
  Stage stage({two_fingers()});
  stage.put(stage.add(test::box_mesh({0.03, 0.03, 0.02})), Vec3(0, 0, 0.01));
  const std::size_t shelf = stage.add(test::box_mesh({0.06, 0.06, 0.004}));
  stage.loaded.request.parts[shelf].fixed = true;
  stage.put(shelf, Vec3(0.035, 0, 0.036));
  stage.scene.parts.back().state = PartState::fixed;
  EXPECT_EQ(pick_of(stage.find(), 0).blocked_by, (std::vector<int>{1}));
  EXPECT_EQ(pick_of(stage.find(), 0).depth, -1);
  stage.loaded.request.lift_cone = 0.3;
  EXPECT_EQ(pick_of(stage.find(), 0).blocked_by, (std::vector<int>{1}));
  stage.loaded.request.lift_cone = 0.9;
  const SceneGrasps found = stage.find();
  const PartPick& pick = pick_of(found, 0);
  EXPECT_TRUE(pick.blocked_by.empty());
  EXPECT_EQ(pick.depth, 0);
  EXPECT_LT(pick.lift.x(), -0.02);
  const double tilt = std::acos(pick.lift.normalized().z());
  EXPECT_GT(tilt, 0.6);  // it has to move 10 mm aside over the 14 mm up to the shelf
  EXPECT_LE(tilt, 0.9 + 1e-9);
  EXPECT_NEAR(pick.lift.z(), 0.1, 1e-9);  // out of the bin
  EXPECT_GT(free_of(found, 0), 0u);
  for (const SceneGrasp& grasp : found.grasps) {
    if (grasp.part == 0 && grasp.free()) {
      EXPECT_LT(grasp.pose.position.x(), 0.01);
    }
  }
}

TEST(SceneGrasps, ThePalmOfABentToolLeans) {
  // The flange is turned by 40 degrees about y: the palm hits the wall of the bin on one side only.
  Gripper gripper = two_fingers();
  gripper.tool_rotation = Vec3(0.0, 0.7, 0.0);
  const Pose flange = gripper.flange();
  const Vec3 axis = flange.orientation * Vec3::UnitZ();
  EXPECT_NEAR(std::acos(axis.z()), 0.7, 1e-12);
  // The centre of the palm's front is where the fingers end, whatever the rotation.
  const Vec3 front = flange * Vec3(0.0, 0.0, gripper.palm.z());
  EXPECT_NEAR((front - Vec3(0.0, 0.0, 0.5 * gripper.pad_length - gripper.finger_depth)).norm(), 0.0, 1e-12);
  gripper.tool_rotation = Vec3::Zero();
  EXPECT_NEAR((gripper.flange().position - Vec3(0, 0, 0.005 - 0.04 - gripper.palm.z())).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace bin_scenes
