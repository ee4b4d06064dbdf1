/// A gripper's jaws and the pull of its cup, against closed forms, in four lengths of step.
#include "pour/settling.hpp"
#include "solver/fixture.hpp"
#include "solver/sphere/sphere_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes::testing {
namespace {

constexpr double g = 9.81, mass = 0.05, friction = 0.5;
const Vec3 block_size(0.03, 0.02, 0.02);

class Held : public ::testing::TestWithParam<int> {
 protected:
  Lab lab() {
    SphereSettings settings;
    settings.time_step /= GetParam();
    Lab lab(make_sphere_solver(settings));
    lab.def().bin.kind = Bin::Kind::none;
    return lab;
  }
};

BodyDef fixed_of(double with_friction) {
  BodyDef body = material(with_friction);
  body.fixed = true;
  return body;
}

/// Two pads beside a block, each `gap` away from it, that close along x. They are small: on wide ones the forces of
/// contacts have no single answer, and where they do not centre on the weight, friction holds a moment as well.
struct Plates {
  Lab lab;
  std::size_t block, first, second;
  Jaws jaws;

  Plates(Lab in, double force, double gap, const Vec3& gravity = Vec3(0, 0, -g)) : lab(std::move(in)) {
    lab.def().gravity = gravity;
    const PartModelPtr plate = box(Vec3(0.01, 0.006, 0.006));
    const double x = 0.5 * block_size.x() + gap + 0.005;
    block = lab.place(box(block_size), Vec3::Zero(), Quat::Identity(), material(friction, 0.0, mass));
    first = lab.place(plate, Vec3(-x, 0, 0), Quat::Identity(), fixed_of(friction));
    second = lab.place(plate, Vec3(x, 0, 0), Quat::Identity(), fixed_of(friction));
    lab.begin(phases::press);
    jaws = {first, second, Vec3::UnitX(), force, 0.04, 4.0 * mass, Vec3::Zero()};
    close();
  }
  void close() { lab.solver().set_jaws(lab.world(), jaws); }
  double width() const { return lab.center(second).x() - lab.center(first).x() - 0.01; }
  Vec3 press(std::size_t jaw) const { return lab.wrench(block, static_cast<int>(jaw)).force; }
};

/// With which two plates just hold the block.
constexpr double just = mass * g / (2.0 * friction);

TEST_P(Held, SlipsWhereFrictionNoLongerCarriesTheWeight) {
  for (const double share : {0.99, 1.01}) {
    Plates plates(lab(), share * just, 0.0);
    plates.lab.simulate(0.1);
    const double from = plates.lab.center(plates.block).z();
    plates.lab.simulate(0.6);
    const double fallen = from - plates.lab.center(plates.block).z(), free = 0.5 * 0.01 * g * 0.6 * 0.6;
    if (share < 1.0)
      EXPECT_GT(fallen, 0.8 * free);
    else
      EXPECT_LT(fallen, 2e-5);
  }
}

TEST_P(Held, EachPlatePressesWithItsForce) {
  Plates plates(lab(), 20.0, 0.002);
  plates.lab.simulate(0.3);
  EXPECT_NEAR(plates.press(plates.first).x(), 20.0, 0.02);
  EXPECT_NEAR(plates.press(plates.second).x(), -20.0, 0.02);
  EXPECT_NEAR(plates.press(plates.first).z() + plates.press(plates.second).z(), mass * g, 0.005 * mass * g);
  EXPECT_NEAR(plates.width(), block_size.x(), 2e-5);
}

TEST_P(Held, ClosesAtItsSpeedUntilSomethingIsThere) {
  Plates plates(lab(), 20.0, 0.01);
  plates.lab.simulate(0.1);
  EXPECT_NEAR(plates.width(), block_size.x() + 0.02 - 2.0 * 0.04 * 0.1, 1e-4);
  EXPECT_NEAR(plates.lab.state(plates.first).velocity.linear.x(), 0.04, 1e-6);
}

TEST_P(Held, FollowsTheHand) {
  Plates plates(lab(), 3.0 * just, 0.0);
  plates.lab.simulate(0.1);
  const Vec3 block = plates.lab.center(plates.block), jaw = plates.lab.center(plates.first);
  plates.jaws.velocity = Vec3(0.05, 0.02, 0.1);
  plates.close();
  plates.lab.simulate(0.5);
  const Vec3 displacement = 0.5 * plates.jaws.velocity;
  EXPECT_LT((plates.lab.center(plates.first) - jaw - displacement).norm(), 1e-4);
  // Friction needs a moment to bring it up to that speed: v^2 / 2 a, a being what friction spares.
  EXPECT_LT((plates.lab.center(plates.block) - block - displacement).norm(), 0.102 * 0.102 / (2.0 * 2.0 * g) + 2e-4);
  EXPECT_LT((plates.lab.state(plates.block).velocity.linear - plates.jaws.velocity).norm(), 1e-3);
}

// The lower plate presses with what the upper one does and the block weighs along the axis; both together with 2 F.
TEST_P(Held, TheWeightAlongTheAxisIsSharedByBoth) {
  const double angle = 0.5, force = 4.0;
  Plates plates(lab(), force, 0.0, g * Vec3(-std::sin(angle), 0, -std::cos(angle)));
  plates.lab.simulate(0.3);
  const double first = plates.press(plates.first).x(), second = -plates.press(plates.second).x();
  EXPECT_NEAR(first + second, 2.0 * force, 0.002 * force);
  EXPECT_NEAR(first - second, mass * g * std::sin(angle), 0.01 * mass * g);
}

// A block with an arm at its foot, so that its weight acts beside the pads. They hold the moment by pressing at
// opposite ends, 2 h F, and by what friction spares, w (mu F - m g / 2).
TEST_P(Held, HoldsAMomentAcrossItsAxis) {
  const double width = 0.008, half = 0.003;
  for (const double share : {0.98, 1.02}) {
    Lab lab = this->lab();
    const PartModelPtr part = PartModel::from_mesh(
        merged(box_mesh(Vec3(width, 0.02, 0.02)), box_mesh(Vec3(0.04, 0.02, 0.004), Vec3(0.016, 0, -0.012))), "arm");
    const Vec3 center = part->mass().center;
    const double force = share * mass * g * (center.x() + 0.5 * width) / (2.0 * half + friction * width);
    const auto arm = lab.place(part, center, Quat::Identity(), material(friction, 0.0, mass));
    const PartModelPtr pad = box(Vec3(0.01, 2.0 * half, 2.0 * half));
    const double x = 0.5 * width + 0.005;
    const auto first = lab.place(pad, Vec3(-x, 0, 0), Quat::Identity(), fixed_of(friction));
    const auto second = lab.place(pad, Vec3(x, 0, 0), Quat::Identity(), fixed_of(friction));
    lab.begin(phases::press);
    lab.solver().set_jaws(lab.world(), {first, second, Vec3::UnitX(), force, 0.04, 4.0 * mass, Vec3::Zero()});
    lab.simulate(0.3);
    const double turned = 2.0 * lab.state(arm).pose.orientation.vec().norm();
    if (share < 1.0)
      EXPECT_GT(turned, 0.02);
    else
      EXPECT_LT(turned, 0.005);
  }
}

/// The block hangs under a ring that is carried.
struct Cup {
  static constexpr double radius = 0.008;
  Lab lab;
  std::size_t block, ring;

  Cup(Lab in, const Vec3& gravity, double force, double off = 0.0) : lab(std::move(in)) {
    lab.def().gravity = gravity;
    block = lab.place(box(block_size), Vec3::Zero(), Quat::Identity(), material(friction, 0.0, mass));
    ring = lab.place(PartModel::from_mesh(ring_mesh(32, 0.7 * radius, radius, 0.02), "ring"),
                     Vec3(off, 0, 0.5 * block_size.z() + 0.01), Quat::Identity(), fixed_of(friction));
    lab.begin(phases::press);
    lab.solver().set_force(lab.world(), block, Vec3(0, 0, force), Vec3(off, 0, 0.5 * block_size.z()));
  }
  double gap() const { return -lab.center(block).z(); }
};

TEST_P(Held, CupHoldsWhatItPullsMoreThanItWeighs) {
  for (const double share : {0.99, 1.01}) {
    Cup cup(lab(), Vec3(0, 0, -g), share * mass * g);
    cup.lab.simulate(0.5);
    if (share < 1.0)
      EXPECT_GT(cup.gap(), 0.8 * 0.5 * 0.01 * g * 0.25);
    else
      EXPECT_LT(std::abs(cup.gap()), 2e-5);
  }
}

TEST_P(Held, CupHoldsSidewaysWhatFrictionOfItsRingDoes) {
  for (const double share : {0.99, 1.01}) {
    // Through the ring's plane, so that nothing tilts: gravity acts at the middle of the block.
    const double force = share * mass * g / friction;
    Cup cup(lab(), Vec3(0, g, 0), force);
    cup.lab.simulate(0.5);
    const double distance = cup.lab.center(cup.block).y();
    if (share < 1.0)
      EXPECT_GT(distance, 0.8 * 0.5 * 0.01 * g * 0.25);
    else
      EXPECT_LT(distance, 1e-4);
  }
}

// The weight acts beside the cup: about the edge of the ring, F r = m g (off + r).
TEST_P(Held, CupIsTornOffByAMomentThatItsRingCannotGive) {
  const double off = 0.005, holds = mass * g * (off + Cup::radius) / Cup::radius;
  for (const double share : {0.98, 1.02}) {
    Cup cup(lab(), Vec3(0, 0, -g), share * holds, off);
    double turned = 0.0;  // at most: the pull keeps its direction, so that what tilts swings back
    while (cup.lab.time() < 0.3) {
      cup.lab.simulate(0.02);
      turned = std::max(turned, 2.0 * cup.lab.state(cup.block).pose.orientation.vec().norm());
    }
    if (share < 1.0)
      EXPECT_GT(turned, 0.03);
    else
      EXPECT_LT(turned, 5e-3);  // as it is let go
  }
}

INSTANTIATE_TEST_SUITE_P(Sphere, Held, ::testing::Values(1, 2, 4, 8),
                         [](const auto& info) { return "step_" + std::to_string(info.param); });

TEST(HeldOthers, GripperWakesWhatItTouchesAndKeepsItAwake) {
  Lab lab(make_sphere_solver({}));
  const auto part = lab.place(box(Vec3::Constant(0.02)), Vec3(0, 0, 0.01), Quat::Identity(), material(0.5, 0.0, mass));
  const auto far = lab.place(box(Vec3::Constant(0.02)), Vec3(0.2, 0, 0.01), Quat::Identity(), material(0.5, 0.0, mass));
  const PartModelPtr plate = box(Vec3(0.01, 0.03, 0.04));
  const auto first = lab.place(plate, Vec3(-0.02, 0, 0.015), Quat::Identity(), fixed_of(0.5));
  const auto second = lab.place(plate, Vec3(0.02, 0, 0.015), Quat::Identity(), fixed_of(0.5));
  lab.begin(phases::repair);
  lab.solver().set_jaws(lab.world(), {first, second, Vec3::UnitX(), 20.0, 0.04, 0.2, Vec3::Zero()});
  lab.simulate(0.5);  // plates enter the floor: it is nothing to them
  lab.solver().set_jaws(lab.world(), {first, second, Vec3::UnitX(), 20.0, 0.04, 0.2, Vec3(0, 0, 0.1)});
  lab.simulate(0.5);
  EXPECT_NEAR(lab.center(part).z(), 0.06, 1e-3);
  EXPECT_TRUE(lab.solver().asleep(lab.world())[far]);
}

// So many bodies are solved in several blocks; the jaws must be in one.
TEST(HeldOthers, JawsHoldInAWideWorld) {
  Lab lab(make_sphere_solver({}));
  const PartModelPtr cube = box(Vec3::Constant(0.02)), plate = box(Vec3(0.01, 0.03, 0.04));
  const auto first = lab.place(plate, Vec3(-0.017, 0, 0.025), Quat::Identity(), fixed_of(0.5));
  std::size_t part = 0;
  for (int i = 0; i < 600; ++i) {
    const std::size_t body =
        lab.place(cube, Vec3(0.1 * (i % 25), 0.1 * (i / 25), 0.01), Quat::Identity(), material(0.5, 0.0, mass));
    if (i == 0) part = body;
  }
  const auto second = lab.place(plate, Vec3(0.017, 0, 0.025), Quat::Identity(), fixed_of(0.5));
  lab.begin(phases::press);
  lab.solver().set_jaws(lab.world(), {first, second, Vec3::UnitX(), 20.0, 0.04, 0.2, Vec3::Zero()});
  lab.simulate(0.02);  // all others are awake
  EXPECT_NEAR(lab.state(first).velocity.linear.x(), 0.04, 1e-6);
  EXPECT_NEAR(lab.state(second).velocity.linear.x(), -0.04, 1e-6);
  lab.simulate(0.13);
  lab.solver().set_jaws(lab.world(), {first, second, Vec3::UnitX(), 20.0, 0.04, 0.2, Vec3(0, 0, 0.1)});
  lab.simulate(0.1);
  EXPECT_NEAR(lab.center(part).z(), 0.02, 1e-3);
}

TEST(HeldOthers, OtherSolversSayThatTheyCannot) {
  Request request;
  request.solver.type = SolverType::bullet;
  std::string reason;
  const PartModelPtr part = box(block_size);
  Lab lab(make_solver({request, {part}}, reason));
  lab.place(part, Vec3(0, 0, 0.01));
  lab.begin(phases::press);
  const auto problem = [&](const auto& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.kind() == ErrorKind::input ? error.problem() : std::string();
    }
    return std::string();
  };
  EXPECT_EQ(problem([&] { lab.solver().set_jaws(lab.world(), {}); }), "grippers are not simulated by bullet");
  EXPECT_EQ(problem([&] { lab.solver().set_force(lab.world(), 0, Vec3::Zero(), Vec3::Zero()); }),
            "grippers are not simulated by bullet");
}

}  // namespace
}  // namespace bin_scenes::testing
