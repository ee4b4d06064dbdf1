#include "solver/sphere/world.hpp"

#include "solver/sphere/invariants.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <chrono>

namespace bin_scenes::sphere {

namespace {

/// A pass, and what it takes added to `ms`.
void timed(void (*pass)(World&), World& world, double& ms) {
  stop_if_cancelled();
  const auto begin = std::chrono::steady_clock::now();
  pass(world);
  ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

void step(World& world) {
  ++world.counters.steps;
  const AssertionScope place({world.scene, static_cast<std::int64_t>(world.counters.steps)});
  BIN_SCENES_ASSERT(world.settings.time_step > 0 && manifolds_ascend(world));
  world.clock += world.settings.time_step;
  bool any_moves = false;
  for (const Body& b : world.bodies) {
    any_moves |= b.moves();
    world.counters.asleep_steps += b.present && b.asleep;
  }
  if (!any_moves) return;
  Spent& spent = world.spent;
  timed(find_pairs, world, spent.find_pairs);
  timed(find_contacts, world, spent.find_contacts);
  timed(wake_struck, world, spent.update_sleep);
  timed(color_manifolds, world, spent.color_manifolds);
  note_depths(world);
  timed(solve, world, spent.solve);
  if (world.cuts_rolling()) note_rolling(world);
  timed(update_sleep, world, spent.update_sleep);
  if (world.cold_steps > 0) --world.cold_steps;
  world.forgets = false;
}

}  // namespace bin_scenes::sphere
