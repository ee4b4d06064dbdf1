#include "grasp/holding.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace bin_scenes {
namespace {

// The same block as in HoldsAMomentAcrossItsAxis of test/solver/sphere/jaws_test.cpp, where it is simulated.
TEST(Holding, AWeightBesideThePadsTurnsOutOfThem) {
  const double weight = 0.05 * 9.81, friction = 0.5, width = 0.008, half = 0.003, beside = 0.008;
  Grasp grasp;
  grasp.width = width;
  grasp.radius = 0.002;
  grasp.first = {Vec3(-0.5 * width, -half, -half), Vec3(-0.5 * width, half, half)};
  grasp.second = {Vec3(0.5 * width, -half, -half), Vec3(0.5 * width, half, half)};
  const Pose down{Vec3::Zero(), Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()))};
  // 2 h F of the pads' ends, and the couple of what friction spares: w (mu F - m g / 2).
  const double just = weight * (beside + 0.5 * width) / (2.0 * half + friction * width);
  for (const double side : {-1.0, 1.0})
    for (const double share : {0.99, 1.0, 1.01, 3.0}) {
      Gripper gripper;
      gripper.force = share * just;
      const Burden burden{weight, Vec3(0, 0, -weight), Vec3(side * beside, 0, -0.006), Vec3::UnitZ()};
      const Hold hold = hold_of(grasp, down, gripper, friction, burden);
      EXPECT_EQ(hold.safety > 1.0 + 1e-9, share > 1.0) << share;
      if (share == 1.0) {
        EXPECT_NEAR(hold.friction, friction, 1e-9);
      }
      // The load may grow until both pads just hold it.
      EXPECT_NEAR(hold.safety, share, 1e-9);
      if (share == 3.0) {
        EXPECT_NEAR(hold.moment,
                    beside * weight / (gripper.force * 2.0 * half + width * (friction * gripper.force - 0.5 * weight)),
                    1e-9);
      }
    }
}

TEST(Holding, ACupLosesHalfOfItsVacuumAtItsWidestGap) {
  Gripper gripper;
  gripper.type = Gripper::Type::suction;
  gripper.stiffness = 0.0;
  Grasp grasp;
  grasp.radius = gripper.radius;
  for (const auto& [gap, share] : {std::pair(0.0, 1.0), std::pair(0.5, 8.0 / 9.0), std::pair(1.0, 0.5)}) {
    grasp.gap = gap * gripper.lip;
    EXPECT_NEAR(vacuum_of(grasp, gripper), share * gripper.force, 1e-12);
    const double weight = 5.0;
    const Pose down{Vec3::Zero(), Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()))};
    const Burden burden{weight, Vec3(0, 0, -weight), Vec3(0, 0, -0.01), Vec3::UnitZ()};
    EXPECT_NEAR(hold_of(grasp, down, gripper, 0.5, burden).safety, share * gripper.force / weight, 1e-9);
  }
}

TEST(Holding, SlidingAloneLeavesTheMomentOut) {
  Grasp grasp;
  grasp.width = 0.01;
  grasp.radius = 0.002;
  grasp.friction = 0.1;
  grasp.first = grasp.second = {Vec3::Constant(-1e-9), Vec3::Constant(1e-9)};
  Gripper gripper;
  gripper.force = 3.0;
  const Pose down{Vec3::Zero(), Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()))};
  for (const double beside : {0.0, 0.02, 0.05}) {
    const Burden burden{2.0, Vec3(0, 0, -2.0), Vec3(0, beside, -0.01), Vec3::UnitZ()};
    const Hold hold = hold_of(grasp, down, gripper, 0.5, burden);
    EXPECT_NEAR(hold.sliding, (0.5 - 0.1) * 2.0 * 3.0 / 2.0, 1e-12);
    EXPECT_EQ(hold.safety<hold.sliding - 1e-6, beside> 0.0) << beside;
  }
}

// Weights beside the pads turn a part out of fingers that press from outside and from within by the same moment.
TEST(Holding, FromWithinPadsHoldTheSameMoment) {
  Grasp grasp;
  grasp.width = 0.03;
  grasp.radius = 0.002;
  grasp.first = {Vec3(-0.015, -0.003, -0.002), Vec3(-0.015, 0.003, 0.002)};
  grasp.second = {Vec3(0.015, -0.003, -0.002), Vec3(0.015, 0.003, 0.002)};
  const Pose down{Vec3::Zero(), Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()))};
  const Burden burden{1.0, Vec3(0, 0, -1.0), Vec3(0.004, 0.002, -0.01), Vec3::UnitZ()};
  const double outer = hold_of(grasp, down, Gripper(), 0.5, burden).safety;
  grasp.inner = true;
  EXPECT_NEAR(hold_of(grasp, down, Gripper(), 0.5, burden).safety, outer, 1e-9);
  // Contacts that are apart along the approach: from outside the lower pad lies behind the upper one, as seen from the
  // moment; from within it is the other way round.
  grasp.first = {Vec3(-0.015, -0.003, 0.002), Vec3(-0.015, 0.003, 0.004)};
  grasp.second = {Vec3(0.015, -0.003, -0.004), Vec3(0.015, 0.003, -0.002)};
  const double within = hold_of(grasp, down, Gripper(), 0.5, burden).moment;
  grasp.inner = false;
  std::swap(grasp.first, grasp.second);
  std::swap(grasp.first.lower.x(), grasp.second.lower.x());
  std::swap(grasp.first.upper.x(), grasp.second.upper.x());
  EXPECT_NEAR(hold_of(grasp, down, Gripper(), 0.5, burden).moment, within, 1e-9);
}

}  // namespace
}  // namespace bin_scenes
