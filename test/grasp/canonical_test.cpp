/// Single parts on the floor, for which any engineer would name the same grasp: the best one that is free has to be it.
#include "canonical_parts.hpp"
#include "stage.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace bin_scenes {
namespace {

using test::cup, test::Stage, test::two_fingers;

/// As config/grippers/robotiq_2f_85.yaml.
Gripper large_fingers() {
  Gripper gripper;
  gripper.name = "large";
  gripper.stroke = 0.085;
  gripper.force = 60.0;
  gripper.friction = 0.6;
  gripper.finger_width = 0.022;
  gripper.pad_length = 0.0375;
  gripper.finger_depth = 0.045;
  gripper.finger_thickness = 0.012;
  gripper.palm = Vec3(0.14, 0.075, 0.10);
  gripper.opening = 0.006;
  return gripper;
}

/// As config/grippers/franka_hand.yaml.
Gripper franka() {
  Gripper gripper;
  gripper.name = "franka";
  gripper.stroke = 0.08;
  gripper.force = 70.0;
  gripper.friction = 0.6;
  gripper.palm = Vec3(0.204, 0.063, 0.066);
  gripper.finger_width = 0.0175;
  gripper.finger_depth = 0.047;
  gripper.finger_thickness = 0.0152;
  gripper.pad_length = 0.0185;
  gripper.opening = 0.006;
  return gripper;
}

Gripper slim_fingers() {
  Gripper gripper = two_fingers();
  gripper.finger_width = 0.008;
  gripper.finger_thickness = 0.004;
  return gripper;
}

/// The best free grasp of a part that stands or lies at a pose.
struct Best {
  bool any = false;
  SceneGrasp grasp;
  Vec3 closing, approach, place;  ///< model frame
  double tilt = 0.0;              ///< degrees

  Best(const Gripper& gripper, const Mesh& mesh, const Pose& pose) {
    Stage stage({gripper});
    stage.loaded.request.bin.inner_size = Vec3(0.4, 0.4, 0.1);  // wide enough for each palm at each turn
    stage.put(stage.add(mesh), pose.position, pose.orientation);
    for (const SceneGrasp& one : stage.find().grasps) {
      if (!one.free() || (any && one.score <= grasp.score)) continue;
      any = true;
      grasp = one;
    }
    const Pose local = pose.inverse() * grasp.pose;
    closing = local.orientation * Vec3::UnitX();
    approach = local.orientation * Vec3::UnitZ();
    place = local.position;
    const GraspColumns& c = grasp.columns;
    std::printf(
        "%s: score %.4f width %.1f mm: safety %.2f antipodal %.2f moment %.2f overlap %.2f upright %.2f "
        "clearance %.2f closing %.2f; at %.1f %.1f %.1f mm\n",
        gripper.name.c_str(), grasp.score, 1e3 * grasp.width, c.safety, c.antipodal, c.moment, c.overlap, c.upright,
        c.clearance, c.closing, 1e3 * place.x(), 1e3 * place.y(), 1e3 * place.z());
    tilt = 180.0 / M_PI * std::acos(std::min(1.0, -(grasp.pose.orientation * Vec3::UnitZ()).z()));
  }
};

TEST(CanonicalGrasps, CubeFromAboveByTwoFaces) {
  for (const Gripper& gripper : {two_fingers(), large_fingers(), slim_fingers(), franka()}) {
    // Any turn about the vertical, which is no principal axis more than another.
    for (const double turn : {0.0, 0.4}) {
      const Best best(gripper, test::box_mesh(Vec3::Constant(0.04)),
                      {Vec3(0, 0, 0.02), Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()))});
      ASSERT_TRUE(best.any);
      EXPECT_LT(best.tilt, 0.1) << gripper.name;
      EXPECT_NEAR(best.closing.cwiseAbs().maxCoeff(), 1.0, 1e-9);
      EXPECT_NEAR(best.closing.z(), 0.0, 1e-9);
      EXPECT_LT(best.place.head<2>().norm(), 0.004) << best.place.transpose();
    }
  }
}

TEST(CanonicalGrasps, BrickFromAboveAcrossItsNarrowerSide) {
  const Best best(large_fingers(), test::box_mesh({0.06, 0.04, 0.02}), {Vec3(0, 0, 0.01), Quat::Identity()});
  ASSERT_TRUE(best.any);
  EXPECT_LT(best.tilt, 0.1);
  EXPECT_NEAR(std::abs(best.closing.y()), 1.0, 1e-9);
  EXPECT_NEAR(best.grasp.width, 0.04, 1e-9);
  EXPECT_LT(std::abs(best.place.x()), 0.006);
}

TEST(CanonicalGrasps, LyingCylinderFromAboveAcrossItsAxis) {
  const Quat lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));
  for (const Gripper& gripper : {large_fingers(), two_fingers(), franka()}) {
    const Best best(gripper, test::prism_mesh(0.012, 0.06, 48), {Vec3(0, 0, 0.012), lying});
    ASSERT_TRUE(best.any);
    EXPECT_LT(best.tilt, 4.0) << gripper.name;
    EXPECT_LT(std::abs(best.closing.z()), 0.01);
    EXPECT_NEAR(best.grasp.width, 0.024, 2e-4);
    EXPECT_LT(std::abs(best.place.z()), 0.005);
  }
}

TEST(CanonicalGrasps, BoltByItsShaft) {
  // On the edge of its head and the end of its shaft.
  const double lean = std::asin((0.0065 - 0.004) / 0.030);
  const Quat lying(Eigen::AngleAxisd(M_PI / 2 - lean, Vec3::UnitY()));
  const Mesh mesh = test::bolt_mesh();
  double lowest = 0.0;
  for (const Vec3& v : mesh.vertices) lowest = std::min(lowest, (lying * v).z());
  for (const Gripper& gripper : {slim_fingers(), two_fingers(), large_fingers(), franka()}) {
    const Best best(gripper, mesh, {Vec3(0, 0, -lowest), lying});
    ASSERT_TRUE(best.any) << gripper.name;
    EXPECT_LT(best.tilt, 8.0) << gripper.name;
    EXPECT_LT(std::abs(best.closing.z()), 0.2);
    EXPECT_NEAR(best.grasp.width, 0.008, 3e-4) << gripper.name;
    EXPECT_LT(best.place.z(), 0.0);
    EXPECT_GT(best.place.z(), -0.020);  // the half towards the head, where the centre of mass is
  }
}

TEST(CanonicalGrasps, RingByItsWall) {
  // Fingers narrow enough for the hole; wider ones rest on two lines in it.
  const Mesh mesh = test::ring(0.03, 0.022, 0.01, 48).mesh;
  for (const Gripper& gripper : {slim_fingers(), two_fingers(), franka()}) {
    const Best best(gripper, mesh, {Vec3(0, 0, 0.005), Quat::Identity()});
    ASSERT_TRUE(best.any) << gripper.name;
    EXPECT_LT(best.tilt, 4.0) << gripper.name;
    EXPECT_LT(best.grasp.width, 0.0121) << gripper.name;
    EXPECT_LT(std::abs(best.closing.z()), 0.1);
  }
}

TEST(CanonicalGrasps, PlateBySuctionAtItsCentreOfMass) {
  const Best best(cup(), test::box_mesh({0.08, 0.06, 0.005}), {Vec3(0, 0, 0.0025), Quat::Identity()});
  ASSERT_TRUE(best.any);
  EXPECT_LT(best.tilt, 0.1);
  EXPECT_LT(best.place.head<2>().norm(), 0.003) << best.place.transpose();
}

TEST(CanonicalGrasps, CupByItsWall) {
  for (const Gripper& gripper : {slim_fingers(), two_fingers(), franka()}) {
    const Best best(gripper, test::cup_mesh(0.035, 0.05, 0.002), {Vec3(0, 0, 0.025), Quat::Identity()});
    ASSERT_TRUE(best.any) << gripper.name;
    EXPECT_LT(best.tilt, 4.0);
    EXPECT_LT(best.grasp.width, 0.004);
    EXPECT_LT(std::abs(best.closing.z()), 0.1);
  }
}

}  // namespace
}  // namespace bin_scenes
