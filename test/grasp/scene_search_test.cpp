/// Searches of scenes for grasps, beside a brute-force search by other geometry.
#include "brute_force.hpp"
#include "canonical_parts.hpp"
#include "heaps.hpp"
#include "stage.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <tuple>

namespace bin_scenes {
namespace {

using test::BruteForce, test::free_of, test::pick_of, test::Stage;

Gripper slim() {
  Gripper gripper;
  gripper.name = "slim";
  gripper.stroke = 0.06;
  gripper.finger_width = 0.008;
  gripper.finger_thickness = 0.004;
  return gripper;
}

Stage heap(std::size_t number, const Gripper& gripper) {
  Stage stage({gripper});
  stage.loaded.request.bin.inner_size = Vec3(0.30, 0.22, 0.12);
  const std::size_t lines[] = {stage.add(test::bolt_mesh()), stage.add(test::cup_mesh(0.015, 0.030, 0.002)),
                               stage.add(test::hook_mesh())};
  const double densities[] = {7800.0, 2700.0, 2700.0};
  for (std::size_t line = 0; line < 3; ++line) {
    stage.loaded.request.parts[line].density = densities[line];
    stage.loaded.request.parts[line].friction = 0.4;
  }
  for (std::size_t i = 0; i < 60; ++i) {
    const double* p = test::heaps[number][i];
    stage.put(lines[i / 20], Vec3(p[0], p[1], p[2]), Quat(p[6], p[3], p[4], p[5]).normalized());
  }
  return stage;
}

TEST(SceneSearch, FindsAGraspWhereBruteForceDoes) {
  std::size_t graspable = 0, labelled = 0;
  for (std::size_t number = 0; number < 3; ++number) {
    const Stage stage = heap(number, slim());
    const SceneGrasps found = stage.find();
    const BruteForce brute(stage);
    for (const ScenePart& part : stage.scene.parts) {
      if (!brute.uncovered(part.id)) continue;
      std::size_t tried = 0;
      const bool free = free_of(found, part.id) > 0;
      if (!brute.free_grasp(part.id, 60, tried)) continue;
      ++graspable;
      labelled += free;
      if (!free)
        std::printf("heap %zu, part %d: brute force found a grasp after %zu poses; blocked by %zu, searched %zu\n",
                    number, part.id, tried, pick_of(found, part.id).blocked_by.size(),
                    pick_of(found, part.id).searches.empty() ? 0 : pick_of(found, part.id).searches[0].tried);
    }
  }
  std::printf("%zu of %zu parts have a free grasp\n", labelled, graspable);
  EXPECT_GE(graspable, 25u);
  EXPECT_GE(static_cast<double>(labelled), 0.95 * static_cast<double>(graspable));
}

TEST(SceneSearch, MoreGraspsOfAPartLoseNone) {
  Gripper gripper = slim();
  gripper.stroke = 0.08;  // as franka_hand
  gripper.finger_width = 0.0175;
  gripper.pad_length = 0.0185;
  gripper.finger_depth = 0.047;
  gripper.finger_thickness = 0.0152;
  gripper.palm = Vec3(0.204, 0.063, 0.066);
  std::vector<SceneGrasp> smaller;
  for (const std::size_t most : {50, 200, 600}) {
    gripper.most = most;
    Stage stage({gripper});
    stage.put(stage.add(test::hook_mesh()), Vec3(-0.01, -0.02, 0.003));
    const std::vector<SceneGrasp> larger = stage.find().grasps;
    for (const SceneGrasp& one : smaller) {
      const auto same = [&](const SceneGrasp& other) {
        return one.grasp == other.grasp && one.free() == other.free() && one.pose.position == other.pose.position &&
               one.score == other.score;
      };
      EXPECT_TRUE(std::any_of(larger.begin(), larger.end(), same)) << most;
    }
    EXPECT_GT(larger.size(), smaller.size());
    smaller = larger;
  }
}

TEST(SceneSearch, LargeFingersReachWhatLiesOnTheFloor) {
  // As robotiq_2f_85: the pad is so long that the part is 0.4 of it off its centre.
  Gripper gripper = slim();
  gripper.stroke = 0.085;
  gripper.finger_width = 0.022;
  gripper.pad_length = 0.0375;
  gripper.finger_depth = 0.045;
  gripper.finger_thickness = 0.012;
  gripper.palm = Vec3(0.14, 0.075, 0.10);
  const auto search_of = [&](const Mesh& mesh, double height, const Quat& turn) {
    Stage stage({gripper});
    stage.put(stage.add(mesh), Vec3(0, 0, height), turn);
    const SceneGrasps found = stage.find();
    EXPECT_GE(free_of(found, 0), gripper.free_wanted);
    const PartSearch& search = found.parts.at(0).searches.at(0);
    EXPECT_GE(search.free, gripper.free_wanted);
    EXPECT_LE(search.tried, gripper.tries);
    EXPECT_LT(search.least_tilt, 0.1);
  };
  search_of(test::bolt_mesh(), 0.0065, Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY())));
  search_of(test::ring(0.02, 0.012, 0.008, 32).mesh, 0.004, Quat::Identity());
  search_of(test::hook_mesh(), 0.003, Quat::Identity());
}

TEST(SceneSearch, TheBestGraspOfAPartComesFirst) {
  Stage stage({slim(), test::cup()});
  const std::size_t cube = stage.add(test::box_mesh(Vec3::Constant(0.04)));
  stage.put(cube, Vec3(-0.1, 0, 0.02));
  stage.put(cube, Vec3(0.1, 0, 0.02));
  const std::vector<SceneGrasp> grasps = stage.find().grasps;
  ASSERT_GT(grasps.size(), 50u);
  for (std::size_t i = 1; i < grasps.size(); ++i) {
    const SceneGrasp &before = grasps[i - 1], &after = grasps[i];
    const auto order = [](const SceneGrasp& g) { return std::make_tuple(g.part, g.gripper, -g.score); };
    EXPECT_LE(order(before), order(after)) << i;
  }
  EXPECT_TRUE(grasps.front().free());
}

TEST(SceneSearch, EndsAfterItsTries) {
  Gripper gripper = slim();
  gripper.tries = 7;
  Stage stage({gripper});
  stage.put(stage.add(test::box_mesh(Vec3::Constant(0.04))), Vec3(0, 0, 0.02));
  stage.loaded.request.bin.inner_size = Vec3(0.05, 0.05, 0.1);  // no room for a finger
  const SceneGrasps found = stage.find();
  ASSERT_EQ(found.parts.at(0).searches.size(), 1u);
  EXPECT_EQ(found.parts[0].searches[0].tried, 7u);
  EXPECT_EQ(found.parts[0].searches[0].free, 0u);
}

TEST(SceneSearch, StrokeLeavesRoomForEachFinger) {
  for (const double width : {0.0588, 0.05895, 0.0592, 0.06}) {
    Gripper gripper = slim();  // stroke 60 mm, 0.5 mm of room a finger
    Stage stage({gripper});
    stage.put(stage.add(test::box_mesh({width, 0.07, 0.03})), Vec3(0, 0, 0.015));
    EXPECT_EQ(free_of(stage.find(), 0) > 0, width < 0.059) << width;
  }
}

}  // namespace
}  // namespace bin_scenes
