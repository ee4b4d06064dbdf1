/// How much work a heap gets, and what it brings.
#include "boxes.hpp"
#include "pour/settling.hpp"
#include "solver/hard_contact_scenes.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/sphere_solver.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::sphere {
namespace {

// Loads travel about a layer a sweep: of what lies on each other, cubes eight a layer, or one by one in a tower, which
// must not sway either.
TEST(Effort, AHeapOfManyLayersGetsMoreSweeps) {
  PartModelPtr part;
  const float edge = 0.05f;
  const Shape shape = box_shape(part, Vec3::Constant(edge));
  const auto effort = [&](int count, int a_row, int a_layer) {
    World world = world_of_boxes(shape, static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      world.bodies[i].x = edge * Vec3f(i % a_row, i % a_layer / a_row, i / a_layer + 0.5f);
    take_phase(world, phases::press);
    EXPECT_EQ(world.plan().sweeps, world.effort * world.settings.sweeps);
    return world.effort;
  };
  EXPECT_EQ(effort(3, 1, 1), 1);
  EXPECT_EQ(effort(9, 1, 1), 5);    // 0.16 x 27
  EXPECT_EQ(effort(16, 1, 1), 11);  // 0.16 x 64
  EXPECT_EQ(effort(49, 1, 1), 55);  // 0.16 x 343
  EXPECT_EQ(effort(200, 1, 1), 60);
  EXPECT_EQ(effort(38, 2, 2), 5);
  EXPECT_EQ(effort(32, 4, 8), 1);
  EXPECT_EQ(effort(19 * 8, 4, 8), 5);
  EXPECT_EQ(effort(64, 8, 64), 1);
  // One that is dropped from high above is no layer, nor are more layers than parts.
  World world = world_of_boxes(shape, 32);
  for (int i = 0; i < 32; ++i) world.bodies[i].x = edge * Vec3f(i % 4, i / 4, 0.5f);
  world.bodies[7].x.z() = 50;
  take_phase(world, phases::press);
  EXPECT_EQ(world.effort, 1);
  // Layers lie on each other along gravity, and without it not at all.
  World row = world_of_boxes(shape, 19);
  for (int i = 0; i < 19; ++i) row.bodies[i].x = edge * Vec3f(i, 0, 0.5f);
  const auto effort_under = [&](const Vec3f& gravity) {
    row.gravity = gravity;
    row.stiffness = Stiffness::soft;
    take_phase(row, phases::press);
    return row.effort;
  };
  EXPECT_EQ(effort_under({0, 0, -9.81f}), 1);
  EXPECT_EQ(effort_under({-9.81f, 0, -1}), 14);
  EXPECT_EQ(effort_under({0, 0, 0}), 1);
  World two = world_of_boxes(shape, 2);
  two.bodies[1].x.z() = 50;
  take_phase(two, phases::press);
  EXPECT_EQ(two.effort, 1);
}

// Parts sag by the square of a sub-step, which is cut until that is little of their thickness: twice as often under
// four times the load. 20 plates lie in five stacks.
TEST(Effort, AHeapOfThinPartsGetsMoreWork) {
  const auto effort = [](float thickness, float whole_step) {
    PartModelPtr part;
    const Vec3f size(0.05f, 0.03f, thickness);
    const Shape shape = box_shape(part, size.cast<double>(), 0.2 * thickness);
    World world = world_of_boxes(shape, 20);
    world.least_thickness = shape.thickness;
    world.whole_step = whole_step;
    for (int i = 0; i < 20; ++i) world.bodies[i].x = size.cwiseProduct(Vec3f(i % 5, 0, i / 5 + 0.5f));
    take_phase(world, phases::press);
    return world.effort;
  };
  EXPECT_EQ(effort(0.005f, 0.0025f), 1);
  EXPECT_EQ(effort(0.0005f, 0.0025f), 1);
  EXPECT_EQ(effort(0.0005f, 0.005f), 2);
  EXPECT_EQ(effort(0.0005f, 0.010f), 3);
  EXPECT_EQ(effort(0.0005f, 0.020f), 5);
}

// While a heap is poured it gets the work of what will lie in the bin, where a quarter is parts: 30 plates 2.7 layers,
// a bin that is full 12, however many more there are.
TEST(Effort, AHeapOfThinPartsGetsMoreWorkFromThePourOn) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.03, 0.02, 0.001}, 0.0002);
  const auto effort = [&](std::size_t count, Bin::Kind kind) {
    WorldDef def;
    def.parts = {part};
    def.bodies.resize(count);
    def.bin.kind = kind;
    def.bin.inner_size = Vec3(0.05, 0.04, 0.15);
    return make_world(def, {}, [&](const PartModelPtr&) -> const Shape& { return shape; }).effort;
  };
  EXPECT_EQ(effort(2, Bin::Kind::box), 1);
  EXPECT_EQ(effort(30, Bin::Kind::box), 2);
  const int full = effort(125, Bin::Kind::box);
  EXPECT_GT(full, 2);
  EXPECT_EQ(effort(5000, Bin::Kind::box), full);
  EXPECT_EQ(effort(30, Bin::Kind::floor), 1);
}

// Soft contacts are springs of a stiffness that grows with the square of the sub-steps, which get their effort. Six
// cubes on each other sag by the weight above each contact over that.
TEST(Effort, SoftContactsOfAHighHeapSagByTheSquareOfItsEffortLess) {
  PartModelPtr part;
  const float edge = 0.05f;
  const Shape shape = box_shape(part, Vec3::Constant(edge));
  constexpr int count = 6;
  const auto sag = [&](float layers, int effort) {
    World world = world_of_boxes(shape, count);
    for (int i = 0; i < count; ++i) world.bodies[i].x = edge * Vec3f(0, 0, i + 0.5f);
    world.planes = {{Vec3f::UnitZ(), 0, false}};
    world.settings.default_layers = layers;
    world.settings.tower_effort = 0;
    world.settings.soft.slop = 0;  // what overlaps by less is held where it is
    take_phase(world, phases::settle);
    EXPECT_EQ(world.effort, effort);
    EXPECT_EQ(world.plan().sub_steps, effort * world.settings.sub_steps);
    EXPECT_EQ(world.plan().sweeps, world.cold_steps > 0 ? world.settings.cold_sweeps : world.settings.sweeps);
    for (int k = 0; k < 400; ++k) step(world);
    return (count - 0.5f) * edge - world.bodies[count - 1].x.z();
  };
  EXPECT_NEAR(sag(100, 1) / sag(1.5f, 4), 16.0f, 1.0f);
}

// A cube of 5 cm (2 volumes over area: a third of its edge) under another gives way by a tenth of that, 1.67 mm, where
// the two weigh as much as 108.7 of it: 9.81 m/s2 x (1.25 ms)2 each.
TEST(Effort, WhatLiesUnderHeavierPartsGetsMoreWork) {
  PartModelPtr part;
  const float edge = 0.05f;
  const Shape shape = box_shape(part, Vec3::Constant(edge));
  const auto effort = [&](float ratio, bool heavy_above) {
    World world = world_of_boxes(shape, 2);
    world.least_thickness = shape.thickness;
    world.whole_step = 0.0025f;
    world.settings.sub_steps = 2;
    for (int i = 0; i < 2; ++i) world.bodies[i].x = edge * Vec3f(0, 0, i + 0.5f);
    world.bodies[heavy_above ? 1 : 0].inverse_mass /= ratio;
    take_phase(world, phases::settle);
    return world.effort;
  };
  for (const bool heavy_above : {true, false}) {  // which of them lies below is not known before they do
    EXPECT_EQ(effort(1, heavy_above), 1);
    EXPECT_EQ(effort(105, heavy_above), 1);
    EXPECT_EQ(effort(110, heavy_above), 2);
    EXPECT_EQ(effort(430, heavy_above), 2);
    EXPECT_EQ(effort(437, heavy_above), 3);
    EXPECT_EQ(effort(1e9f, heavy_above), 8);
  }
}

// Of 5 mm the light one sank into the floor by 15 % of its diagonal, since overlap was let out too slowly to carry the
// heavy one; of 0.3 m both trembled, since stiff contacts had fewer sweeps than soft ones.
TEST(Effort, AThousandTimesAsHeavyStandsOnStiffContacts) {
  for (const double edge : {0.005, 0.05, 0.3})
    for (const double offset : {0.0, 0.1, 0.3})
      for (const double gap : {0.0, 0.02}) {
        const testing::Stood stood =
            testing::stand_on_light_cube(testing::Lab(make_sphere_solver({})), edge, 1000.0, offset, gap);
        EXPECT_LT(stood.deepest, 0.01) << edge << " m, " << offset << " aside, from " << gap;
        EXPECT_LT(stood.moved, 0.02) << edge << " m, " << offset << " aside, from " << gap;
        EXPECT_TRUE(stood.rests) << edge << " m, " << offset << " aside, from " << gap;
      }
}

}  // namespace
}  // namespace bin_scenes::sphere
