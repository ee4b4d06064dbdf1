/// Grasps tried in small heaps whose outcome is known.
#include "bin_scenes/pour/prover.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

using Outcome = LiftProof::Outcome;

Gripper two_fingers() {
  Gripper gripper;
  gripper.name = "two";
  gripper.force = 20.0;
  return gripper;
}

Gripper cup() {
  Gripper gripper;
  gripper.name = "cup";
  gripper.type = Gripper::Type::suction;
  gripper.force = 6.0;
  return gripper;
}

/// Looking down; fingers close along x.
const Quat down(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));

struct Stage {
  LoadedRequest loaded;
  Scene scene;

  explicit Stage(const Gripper& gripper) {
    loaded.request.grippers = {gripper};
    loaded.request.bin.kind = Bin::Kind::floor;
  }
  int put(const Mesh& mesh, double mass, const Vec3& at, const Quat& turn = Quat::Identity(), bool fixed = false) {
    loaded.parts.push_back(PartModel::from_mesh(mesh, "part"));
    PartLine line;
    line.count = 1;
    line.mass = mass;
    line.fixed = fixed;
    loaded.request.parts.push_back(line);
    ScenePart part;
    part.id = static_cast<int>(scene.parts.size());
    part.line = loaded.parts.size() - 1;
    part.pose = {at, turn};
    part.state = fixed ? PartState::fixed : PartState::resting;
    scene.parts.push_back(part);
    return part.id;
  }
  int cube(double mass, const Vec3& at, bool fixed = false) {
    return put(test::box_mesh(Vec3::Constant(0.02)), mass, at, Quat::Identity(), fixed);
  }
  Trial trial(int part, const Vec3& at) const {
    const Gripper& gripper = loaded.request.grippers[0];
    return {part, 0, {at, down}, gripper.type == Gripper::Type::parallel ? 0.02 : 0.0, gripper.force};
  }
  LiftProof prove(int part, const Vec3& at) const {
    return Prover(loaded).prove(scene, loaded, {trial(part, at)}).at(0);
  }
};

TEST(Prover, FingersLiftACubeAndLeaveOthersAlone) {
  Stage stage(two_fingers());
  const int cube = stage.cube(0.05, Vec3(0.001, 0, 0.01));  // one finger meets it first, and pushes it
  stage.cube(0.05, Vec3(0.001, 0.03, 0.01));
  const LiftProof proof = stage.prove(cube, Vec3(0, 0, 0.01));
  EXPECT_EQ(proof.outcome, Outcome::lifted);
  EXPECT_LT(proof.slip, 2e-4);
  EXPECT_LT(proof.turn, 0.01);
  EXPECT_TRUE(proof.dragged.empty());
  EXPECT_TRUE(proof.moved.empty());
}

TEST(Prover, WhatWeighsMoreThanFrictionHoldsSlips) {
  const double holds = 2.0 * 0.5 * 20.0 / (9.81 + 2.0);  // as the lift begins with 2 m/s2
  for (const double share : {0.97, 1.2}) {
    Stage stage(two_fingers());
    const LiftProof proof = stage.prove(stage.cube(share * holds, Vec3(0, 0, 0.01)), Vec3(0, 0, 0.01));
    EXPECT_EQ(proof.outcome, share < 1.0 ? Outcome::lifted : Outcome::slipped) << proof.slip;
  }
}

TEST(Prover, FingersThatMeetNothingMiss) {
  Stage stage(two_fingers());
  const int cube = stage.cube(0.05, Vec3(0, 0, 0.01));
  EXPECT_EQ(stage.prove(cube, Vec3(0, 0.05, 0.01)).outcome, Outcome::missed);
}

TEST(Prover, APartUnderAFixedOneIsJammed) {
  Stage stage(two_fingers());
  const int plank = stage.put(test::box_mesh(Vec3(0.02, 0.1, 0.02)), 0.05, Vec3(0, 0, 0.01));
  stage.cube(1.0, Vec3(0, 0.03, 0.0301), true);
  stage.cube(1.0, Vec3(0, -0.03, 0.0301), true);
  EXPECT_EQ(stage.prove(plank, Vec3(0, 0, 0.01)).outcome, Outcome::jammed);
}

TEST(Prover, NeighboursThatComeAlongAreNamed) {
  Stage stage(two_fingers());
  const int below = stage.put(test::box_mesh(Vec3(0.02, 0.06, 0.02)), 0.05, Vec3(0, 0, 0.01));
  const int above = stage.cube(0.02, Vec3(0, 0.019, 0.03));
  stage.cube(0.02, Vec3(0, 0.041, 0.01));                                          // beside it
  stage.put(test::box_mesh(Vec3(0.02, 0.02, 0.01)), 0.02, Vec3(0, 0.041, 0.025));  // on that
  const LiftProof proof = stage.prove(below, Vec3(0, -0.01, 0.01));
  EXPECT_EQ(proof.outcome, Outcome::dragged);
  EXPECT_EQ(proof.dragged, std::vector<int>{above});
  EXPECT_TRUE(proof.moved.empty());
}

TEST(Prover, WhatLeansOnThePartMoves) {
  Stage stage(two_fingers());
  const int cube = stage.cube(0.05, Vec3(0, 0, 0.01));
  // On its lower edge, with its upper one at the side of the cube.
  const int plate = stage.put(test::box_mesh(Vec3(0.01, 0.002, 0.018)), 0.01, Vec3(0, 0.01444, 0.00868),
                              Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX())));
  const LiftProof proof = stage.prove(cube, Vec3(0, 0, 0.01));
  EXPECT_EQ(proof.outcome, Outcome::lifted);
  EXPECT_EQ(proof.moved, std::vector<int>{plate});
}

TEST(Prover, CupLiftsWhatItsVacuumHolds) {
  const double holds = 6.0 / (9.81 + 2.0);
  for (const double share : {0.97, 1.1}) {
    Stage stage(cup());
    const int plate = stage.put(test::box_mesh(Vec3(0.05, 0.05, 0.01)), share * holds, Vec3(0, 0, 0.005));
    const LiftProof proof = stage.prove(plate, Vec3(0, 0, 0.01));
    EXPECT_EQ(proof.outcome, share < 1.0 ? Outcome::lifted : Outcome::slipped) << proof.slip;
  }
}

TEST(Prover, ATrialIsTheSameAloneAndAmongOthers) {
  Stage stage(two_fingers());
  std::vector<Trial> trials;
  for (int i = 0; i < 3; ++i) {
    const Vec3 at(0.05 * i, 0, 0.01);
    trials.push_back(stage.trial(stage.cube(0.3 + i, at), at));
  }
  Prover prover(stage.loaded);
  const auto together = prover.prove(stage.scene, stage.loaded, trials);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const LiftProof alone = Prover(stage.loaded).prove(stage.scene, stage.loaded, {trials[i]}).at(0);
    EXPECT_EQ(alone.outcome, together[i].outcome);
    EXPECT_EQ(alone.slip, together[i].slip);
    EXPECT_EQ(alone.turn, together[i].turn);
  }
}

}  // namespace
}  // namespace bin_scenes
