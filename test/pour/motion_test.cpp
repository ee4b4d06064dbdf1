/// Bins and parts that follow a given motion, against closed forms, with both solvers.
#include "bin_scenes/pour/heap.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

constexpr double g = 9.81, mu = 0.5, edge = 0.04;

class MotionTest : public ::testing::TestWithParam<SolverType> {
 protected:
  MotionTest() {
    request.solver.type = GetParam();
    request.bin.kind = Bin::Kind::floor;
    request.bin.friction = mu;
    request.pour.pattern = Pour::Pattern::given;
    request.pour.finish = Pour::Finish::settled;
    add(Vec3::Constant(edge), Vec3(0, 0, 0.5 * edge));
  }

  PartLine& add(const Vec3& size, const Vec3& at) {
    parts.push_back(PartModel::from_mesh(box_mesh(size), "box"));
    PartLine line;
    line.model = "box";
    line.friction = mu;
    line.restitution = 0.0;
    line.poses = {{at, Quat::Identity()}};
    request.parts.push_back(line);
    return request.parts.back();
  }

  /// Runs it, and follows the first part.
  Scene run() {
    std::string reason;
    const auto solver = make_solver({request, parts}, reason);
    RunHooks hooks;
    hooks.trace_rate = 200.0;
    hooks.trace = [&](std::size_t, double time, const std::vector<BodyState>& states) {
      times.push_back(time);
      track.push_back(states[0]);
    };
    return pour({request, parts}, *solver, {0}, hooks)[0];
  }
  const BodyState& at(double time) const {
    std::size_t k = 0;
    while (k + 1 < times.size() && times[k] < time - 1e-6) ++k;
    return track[k];
  }
  static Quat turn(double degrees, const Vec3& axis) { return Quat(Eigen::AngleAxisd(degrees * M_PI / 180.0, axis)); }

  Request request;
  std::vector<PartModelPtr> parts;
  std::vector<double> times;
  std::vector<BodyState> track;
};

/// How far a block slides to either side on a floor that is shaken so.
double sliding_amplitude(const Motion& motion) {
  constexpr double dt = 1e-5;
  double x = 0.0, v = 0.0, most = 0.0;
  for (double t = 0.0; t < motion.duration() + 0.5; t += dt) {
    const double push =
        -(motion.at(t + dt).position.x() - 2.0 * motion.at(t).position.x() + motion.at(t - dt).position.x()) / dt;
    const double grip = mu * g * dt, free = v + push;
    v = std::abs(free) <= grip ? 0.0 : free - std::copysign(grip, free);
    x += v * dt;
    most = std::max(most, std::abs(x));
  }
  return most;
}

// Known from the request alone: nothing is poured before it is said.
TEST(MotionRefused, ByASolverThatCannotMoveAnything) {
  const std::vector<PartModelPtr> parts = {PartModel::from_mesh(box_mesh(Vec3::Constant(edge)), "box")};
  Request request;
  PartLine line;
  line.model = "box";
  request.parts.push_back(line);
  request.bin.motion.shake = Vec3(0.01, 0, 0);
  request.solver.preset = SolverSettings::Preset::thesis;
  std::string reason;
  const auto solver = make_solver({request, parts}, reason);
  double simulated = 0.0;
  RunHooks hooks;
  hooks.trace_rate = 200.0;
  hooks.trace = [&](std::size_t, double time, const std::vector<BodyState>&) { simulated = time; };
  EXPECT_THROW(pour({request, parts}, *solver, {0}, hooks), Error);
  EXPECT_EQ(simulated, 0.0);
}

TEST_P(MotionTest, ABlockOnAShakenFloorSlipsOnceItsAccelerationExceedsFriction) {
  for (const double share : {0.9, 2.0}) {
    Motion& motion = request.bin.motion;
    motion.frequency = 5.0;
    motion.seconds = 1.0;
    motion.shake = Vec3(share * mu * g / std::pow(2.0 * M_PI * motion.frequency, 2), 0, 0);
    track.clear();
    times.clear();
    const Scene scene = run();
    EXPECT_TRUE(scene.report.at_rest);
    EXPECT_LT(scene.report.energy.gain, 0.1) << "what the floor does to the block is no gain from nowhere";
    double most = 0.0;
    for (const BodyState& state : track) most = std::max(most, std::abs(state.pose.position.x()));
    const double expected = sliding_amplitude(motion);
    if (share < 1.0)
      EXPECT_LT(most, 2e-4);
    else
      EXPECT_NEAR(most, expected, 0.05 * expected);
  }
}

TEST_P(MotionTest, ABlockOnATiltedFloorSlidesBeyondTheAngleOfFrictionAlone) {
  for (const double degrees : {22.0, 35.0}) {  // atan(0.5) is 26.6 degrees
    request.bin.motion.times = {0.5, 0.8, 1.3};
    request.bin.motion.poses = {
        {Vec3::Zero(), turn(degrees, Vec3::UnitY())}, {Vec3::Zero(), turn(degrees, Vec3::UnitY())}, Pose()};
    track.clear();
    times.clear();
    const Scene scene = run();
    EXPECT_TRUE(scene.report.at_rest);
    const double distance = scene.parts[0].pose.position.x();
    if (degrees < 26.0)
      EXPECT_LT(std::abs(distance), 1e-3);
    else
      EXPECT_GT(distance, 0.05);
  }
}

TEST_P(MotionTest, ABinMayEndTurnedAboutGravityButNotTilted) {
  add(Vec3::Constant(edge), Vec3(0.3 * edge, 0, 1.5 * edge));
  request.bin.motion.times = {3.0};
  request.bin.motion.poses = {{Vec3::Zero(), turn(90.0, Vec3::UnitZ())}};
  EXPECT_NO_THROW(check(request));
  const Scene scene = run();
  EXPECT_TRUE(scene.report.at_rest);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT((scene.parts[i].pose.position - request.parts[i].poses[0].position).norm(), 2e-3 * edge) << i;
  request.bin.motion.poses = {{Vec3::Zero(), turn(0.1, Vec3::UnitY())}};
  EXPECT_THROW(check(request), Error);
}

TEST_P(MotionTest, WhatIsCarriedGentlyAndSetDownStaysWhereItLies) {
  add(Vec3::Constant(edge), Vec3(0.3 * edge, 0, 1.5 * edge));
  request.bin.motion.times = {1.0, 2.0, 3.0};
  request.bin.motion.poses = {{Vec3(0, 0, 0.3), Quat::Identity()},
                              {Vec3(0.5, 0.2, 0.3), Quat::Identity()},
                              {Vec3(0.5, 0.2, 0), Quat::Identity()}};
  const Scene scene = run();
  EXPECT_TRUE(scene.report.at_rest);
  EXPECT_GT(scene.report.simulated_s, 3.0);
  EXPECT_LT((scene.parts[0].pose.position - request.parts[0].poses[0].position).norm(), 1e-3);
  EXPECT_LT((scene.parts[1].pose.position - request.parts[1].poses[0].position).norm(), 1e-3);
}

// Without gravity a free body keeps its velocity and spin, whatever the bin does that it is told in.
TEST_P(MotionTest, AFreeBodyInABinThatTurnsFliesStraightSeenFromOutside) {
  request.gravity.setZero();
  request.bin.kind = Bin::Kind::none;
  request.parts[0].poses[0].position = Vec3(0.1, 0.2, 0.3);
  const Vec3 velocity(0.2, -0.1, 0.3), spin(1.0, 2.0, -1.0);
  request.parts[0].velocities = {{velocity, spin}};
  request.seconds = 0.8;
  request.bin.motion.times = {0.3, 0.6, 0.9};
  request.bin.motion.poses = {
      {Vec3(0.05, 0, 0.1), turn(30, Vec3(1, 2, 0).normalized())}, {Vec3(0, 0.1, 0), turn(-20, Vec3::UnitZ())}, Pose()};
  run();
  for (const double t : {0.2, 0.5, 0.8}) {
    const BodyState& seen = at(t);
    const Pose bin = request.bin.motion.at(t), outside = bin * seen.pose;
    const Vec3 expected = request.parts[0].poses[0].position + t * velocity;
    EXPECT_LT((outside.position - expected).norm(), 2e-3) << t;
    const Quat expected_turn(Eigen::AngleAxisd(spin.norm() * t, spin.normalized()));  // of a cube
    EXPECT_LT(outside.orientation.angularDistance(expected_turn), 5e-3) << t;
  }
}

TEST_P(MotionTest, AConveyorCarriesAtTheSpeedOfItsBelt) {
  request.parts[0].poses[0].position.z() = 0.02 + 0.5 * edge;
  PartLine& belt = add(Vec3(1.0, 0.2, 0.02), Vec3(0, 0, 0.01));
  belt.fixed = true;
  belt.motion.belt = Vec3(0.2, 0, 0);
  belt.motion.seconds = 1.0;
  const Scene scene = run();
  EXPECT_NEAR(at(0.5).velocity.linear.x(), 0.2, 2e-3);
  // It gets under way by friction, and slides on as far when the belt stops.
  EXPECT_NEAR(scene.parts[0].pose.position.x(), 0.2, 2e-3);
  EXPECT_NEAR(scene.parts[1].pose.position.x(), 0.0, 1e-12);
  EXPECT_EQ(scene.parts[1].state, PartState::fixed);
  EXPECT_TRUE(scene.report.at_rest);
}

TEST_P(MotionTest, APusherMovesWhatStandsInItsWayAndIsStoppedByNothing) {
  request.parts[0].mass = 1000.0;
  PartLine& pusher = add(Vec3(0.02, 0.2, edge), Vec3(-0.1, 0, 0.6 * edge));
  pusher.fixed = true;
  pusher.motion.times = {1.0};
  pusher.motion.poses = {{Vec3(0.2, 0, 0), Quat::Identity()}};
  const Scene scene = run();
  EXPECT_NEAR(scene.parts[1].pose.position.x(), 0.1, 1e-6);
  EXPECT_GE(scene.parts[0].pose.position.x(), 0.1 + 0.01 + 0.5 * edge - 1e-3);
  EXPECT_LT(scene.parts[0].pose.position.x(), 0.1 + 0.01 + 0.5 * edge + 0.02);
  EXPECT_TRUE(scene.report.at_rest);
}

TEST_P(MotionTest, WhatIsCarriedOverTheRimMeetsNoWallThere) {
  request.bin.kind = Bin::Kind::box;
  request.bin.inner_size = Vec3(0.2, 0.2, 0.15);
  request.pour.pattern = Pour::Pattern::rain;
  request.parts[0].poses.clear();
  PartLine& tray = add(Vec3(0.19, 0.19, 0.01), Vec3(0, 0, 0.006));
  tray.fixed = true;
  tray.motion.times = {1.0, 3.0};
  tray.motion.poses = {{Vec3(0, 0, 0.17), Quat::Identity()}, {Vec3(0.25, 0, 0.17), Quat::Identity()}};
  EXPECT_EQ(run().parts[0].state, PartState::escaped) << "the walls that held what was poured are gone";
}

TEST_P(MotionTest, APusherThatIsAddedToAHeapMovesAndWhatHasMovedStays) {
  PartLine first = add(Vec3(edge, 0.2, edge), Vec3(-0.3, 0, 0.5 * edge));
  first.fixed = true;
  first.motion.times = {0.5};
  first.motion.poses = {{Vec3(0.1, 0, 0), Quat::Identity()}};
  request.parts.back() = first;
  std::string reason;
  Heap heap({request, parts}, make_solver({request, parts}, reason));
  ASSERT_TRUE(heap.settle());
  ASSERT_NEAR(heap.scene().parts[1].pose.position.x(), -0.2, 1e-4);
  PartLine second = first;
  second.poses = {{Vec3(-0.1, 0, 0.5 * edge + 1e-3), Quat::Identity()}};
  heap.add({{second, parts[1]}});
  ASSERT_TRUE(heap.settle());
  EXPECT_NEAR(heap.scene().parts[2].pose.position.x(), 0.0, 1e-4);
  EXPECT_NEAR(heap.scene().parts[0].pose.position.x(), edge, 2e-3) << "pushed";
  EXPECT_NEAR(heap.scene().parts[1].pose.position.x(), -0.2, 1e-4) << "its motion is over";
}

INSTANTIATE_TEST_SUITE_P(Solvers, MotionTest, ::testing::Values(SolverType::sphere, SolverType::bullet),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace bin_scenes
