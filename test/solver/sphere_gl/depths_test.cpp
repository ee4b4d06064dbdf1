/// Depths of contacts on the GPU: pass note_depths against its twin on the CPU, and what the solver reports of them.
#include "bin_scenes/gl/device.hpp"
#include "handful.hpp"
#include "solver/sphere_gl/batch.hpp"
#include "twin_heap.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace bin_scenes::sphere_gl {
namespace {

using sphere::World;

// In each step the twin begins where the device is, so that both see the same contacts.
TEST(SphereGlDepths, AreThoseOfTheTwin) {
  gl::Device::current().make_current();
  Capacity roomy;
  roomy.pairs = 20;
  roomy.rows = 60;
  roomy.candidates = 64;
  Batch batch(roomy);
  const Heap heap;
  World world = heap.world(40, 3);
  gpu::SphereProgress progress;
  const Batch::Slot slot = batch.add(world, progress);
  progress.steps_left = 1000;
  batch.upload_progress({{slot, progress}});
  std::size_t found = 0;
  for (int step = 0; step < 40; ++step) {
    if (step % 8 == 0) {  // the heap begins with deeper overlaps than come later
      batch.forget_worst(slot);
      world.deepest = {};
    }
    batch.run({slot});
    batch.find_pairs();
    batch.find_contacts();
    batch.color_manifolds();
    ASSERT_EQ(batch.progress(slot).overflow, 0u);
    batch.download(slot, world);
    take_order(world);
    batch.prepare_rows();
    batch.note_depths();
    batch.solve();
    world.clock += batch.progress(slot).time_step;
    const sphere::DeepestContact before = world.deepest;
    note_depths(world);
    solve(world);
    batch.update_sleep();
    const gpu::SphereWorst worst = batch.worst(slot);
    found += world.deepest.time != before.time;
    ASSERT_NEAR(worst.relative, world.deepest.relative, 1e-5f) << step;
    if (worst.relative == 0) continue;
    ASSERT_EQ(worst.a, world.deepest.a) << step;
    ASSERT_EQ(worst.b, world.deepest.b) << step;
    ASSERT_NEAR(worst.depth, world.deepest.depth, 1e-6f) << step;
    ASSERT_NEAR(worst.ago, world.clock - world.deepest.time, 1e-6) << step;
  }
  EXPECT_GT(found, 3u) << "steps with a contact that is deeper than all before";
  EXPECT_LT(found, 35u) << "steps without one";
}

// With a tolerance that no contact meets, each sub-step of a step with an impact ends before it is solved; a step
// without one has none.
TEST(SphereGlDepths, UnresolvedImpactsAreCountedBySubSteps) {
  gl::Device::current().make_current();
  const Heap heap;
  for (const float speed : {1.0f, 0.0f}) {
    World world = heap.world(1, 3);
    world.settings.tolerance = -1;
    world.gravity.setZero();
    world.bodies[0].q = sphere::Quatf::Identity();
    world.bodies[0].x = sphere::Vec3f(0, 0, 0.0105f);
    world.bodies[0].v = sphere::Vec3f(0, 0, -speed);
    world.bodies[0].w.setZero();
    Capacity roomy;
    roomy.candidates = 1024;
    Batch batch(roomy);
    gpu::SphereProgress progress;
    const Batch::Slot slot = batch.add(world, progress);
    progress.steps_left = 1000;
    batch.upload_progress({{slot, progress}});
    batch.run({slot});
    const int sub_steps = world.plan().sub_steps;
    batch.step();
    step(world);
    ASSERT_EQ(batch.progress(slot).overflow, 0u);
    EXPECT_EQ(world.deepest.unresolved_impacts, speed > 0 ? sub_steps : 0);
    EXPECT_EQ(batch.worst(slot).unresolved, world.deepest.unresolved_impacts);
  }
}

TEST(SphereGlDepths, AreTheSameAloneAndInABatch) {
  const auto taken = [](const std::vector<int>& variants, std::size_t place) {
    const auto solver = make_gl_sphere_solver(coarse());
    std::vector<WorldId> ids;
    for (const int variant : variants) ids.push_back(Handful(variant).add(*solver));
    for (int slice = 0; slice < 4; ++slice) solver->advance(ids, 0.05);
    return solver->take_worst_contact(ids[place]).value();
  };
  const WorstContact alone = taken({1}, 0), batched = taken({0, 1, 2}, 1);
  EXPECT_GT(alone.relative, 0.0);
  EXPECT_EQ(alone.relative, batched.relative);
  EXPECT_EQ(alone.depth, batched.depth);
  EXPECT_EQ(alone.ago, batched.ago);
  EXPECT_EQ(alone.a, batched.a);
  EXPECT_EQ(alone.b, batched.b);
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
