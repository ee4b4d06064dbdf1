/// What contacts do in a step, against closed forms.
#include "boxes.hpp"
#include "pour/settling.hpp"
#include "solver/sphere/make_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes::sphere {
namespace {

// One soft contact gives way by g / omega^2 under a weight, beyond the overlap that is left alone (slop); several
// share.
TEST(Solve, ABoxSinksByTheSpringOfItsContactsAndIsPressedOut) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.06});
  World world = world_of_boxes(shape, 1);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  world.fine = true;
  world.settings.sub_steps = 2;
  world.settings.rest_window = 100;  // it must not fall asleep on the way
  world.bodies[0].x = Vec3f(0, 0, 0.03f);
  const auto depth_after = [&](float seconds) {
    for (int k = 0; k < std::lround(seconds / world.settings.time_step); ++k) step(world);
    return 0.03f - world.bodies[0].x.z();
  };
  const auto deepest = [&](const Softness& s) {
    const float rate = world.settings.sub_steps * s.refinement / world.settings.time_step;
    const float omega = 2.0f * static_cast<float>(M_PI) * s.hertz_share * rate;
    return s.slop * shape.size + 9.81f / (omega * omega);
  };
  const Softness &soft = world.settings.soft, &stiff = world.settings.stiff;
  const auto held = [&] {
    float force = 0;
    for (const Contact& c : world.manifolds.at(0).contacts) force += c.normal_force;
    return force * world.bodies[0].inverse_mass / 9.81f;  // of its weight
  };
  const float settled = depth_after(1.0f);
  EXPECT_NEAR(held(), 1.0f, 1e-3f);
  EXPECT_GT(settled, soft.slop * shape.size);
  EXPECT_LT(settled, deepest(soft));
  world.stiffness = Stiffness::stiff;
  step(world);  // shorter sub-steps take over the forces: it is neither dropped nor thrown
  EXPECT_NEAR(held(), 1.0f, 0.05f);
  const float pressed = depth_after(0.3f);
  EXPECT_NEAR(held(), 1.0f, 1e-3f);
  EXPECT_GT(pressed, stiff.slop * shape.size);
  EXPECT_LT(pressed, deepest(stiff));
}

// Of overlap that nothing presses, rigid contacts let out one part in 1 + damping / (pi frequency) a sub-step, and
// carry the weight meanwhile, no more. The speed of it is taken back.
TEST(Solve, RigidContactsLetOverlapOutAndPressNothing) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.06});
  World world = world_of_boxes(shape, 1);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  world.settings.rest_window = 100;
  const float depth = 1e-5f;
  world.bodies[0].x = Vec3f(0, 0, 0.03f - depth);
  take_phase(world, phases::probe);
  const Softness& rigid = world.softness();
  const double share = 1.0 / (1.0 + rigid.damping_ratio / (M_PI * rigid.hertz_share));
  for (int k = 1; k <= 40; ++k) {
    step(world);
    const double left = std::pow(1.0 - share, k * world.plan().sub_steps);
    EXPECT_NEAR((0.03f - world.bodies[0].x.z()) / depth, left, 0.01) << k;
    float force = 0;
    for (const Contact& c : world.manifolds.at(0).contacts) force += c.normal_force;
    EXPECT_NEAR(force * world.bodies[0].inverse_mass / 9.81f, 1.0f, 2e-3f) << k;
    const double speed = share / (1.0 - share) * left * depth / world.plan().sub_step;
    EXPECT_NEAR(world.bodies[0].v.z() / speed, 0.0, 0.1) << k;
  }
}

// On a slope that friction does not hold: as on ice for as long as a probe slips, in its first step at most, then
// braked.
TEST(Solve, AProbeBeginsWithoutFriction) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.01});
  const float g = 9.81f, slope = 0.5f, along = std::sqrt(1 - slope * slope), friction = 0.5f;
  for (const float time_step : {0.001f, 0.0025f, 0.01f}) {
    SCOPED_TRACE(time_step);
    World world = world_of_boxes(shape, 1);
    world.planes = {{Vec3f::UnitZ(), 0, false}};
    world.gravity = g * Vec3f(slope, 0, -along);
    world.bodies[0].x = Vec3f(0, 0, 0.005f);
    world.settings.time_step = time_step;
    take_phase(world, phases::probe);
    const float slips = std::min(world.settings.probe_slip, time_step),
                grip = static_cast<float>(phases::probe.friction);
    const float braked = g * (slope - grip * friction * along);
    for (int k = 1; k <= 3; ++k) {
      step(world);
      const float expected = g * slope * slips + braked * (k * time_step - slips);
      EXPECT_NEAR(world.bodies[0].v.x() / expected, 1.0f, 1e-3f) << k;
    }
  }
}

// A box on a slope that friction holds, with no force remembered: friction is there at once, unlike in a probe.
TEST(Solve, APressAfterAProbeBeginsWithoutForcesButWithFriction) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.01});
  World world = world_of_boxes(shape, 1);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  world.gravity = 9.81f * Vec3f(0.3f, 0, -std::sqrt(1 - 0.3f * 0.3f));
  world.bodies[0].x = Vec3f(0, 0, 0.005f);
  take_phase(world, phases::press);
  EXPECT_FALSE(world.forgets) << "what was never at rest has nothing to forget";
  for (const Phase& phase : {phases::probe, phases::verify, phases::verify}) {
    EXPECT_TRUE(take_phase(world, phase));
    EXPECT_TRUE(world.forgets);
    const float before = world.bodies[0].v.x();
    step(world);
    EXPECT_FALSE(world.forgets);
    if (phase.stiffness == Stiffness::rigid)
      EXPECT_GT(world.bodies[0].v.x() - before, 1e-4f);
    else
      EXPECT_LT(std::abs(world.bodies[0].v.x()), 1e-4f);
    for (int k = 0; k < 20; ++k) step(world);
  }
  EXPECT_TRUE(take_phase(world, phases::settle));
  EXPECT_FALSE(world.forgets);
}

}  // namespace
}  // namespace bin_scenes::sphere
