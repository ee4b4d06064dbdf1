#include "solver/sphere/world.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace bin_scenes::sphere {

namespace {

/// Bodies joined by pressing contacts: union-find over manifolds, walls and fixed bodies left out.
class Islands {
 public:
  explicit Islands(const World& world) : parent_(world.bodies.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const Manifold& m : world.manifolds) {
      if (m.b == ground || world.bodies[m.a].inverse_mass == 0 || world.bodies[m.b].inverse_mass == 0) continue;
      const bool presses =
          std::any_of(m.contacts.begin(), m.contacts.end(), [](const Contact& c) { return c.normal_force > 0; });
      if (presses) join(m.a, m.b);
    }
  }
  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint32_t> parent_;
};

void note_motion(const World& world, Body& b) {
  const Shape& s = *world.shapes[b.shape];
  const float limit = world.settings.rest_move * s.size;
  const float turned = 2.0f * (b.still_q.conjugate() * b.q).vec().norm() * s.radius;
  if ((b.x - b.still_x).norm() > limit || turned > limit) {
    b.still = 0;
    b.still_x = b.x;
    b.still_q = b.q;
  } else {
    b.still += world.settings.time_step;
  }
}

}  // namespace

/// An island sleeps when all its bodies stayed where they are for the rest window; a moving body that presses on a
/// sleeping one wakes the whole island. Never a body alone: that would freeze unsupported parts.
void update_sleep(World& world) {
  for (Body& b : world.bodies)
    if (b.moves()) note_motion(world, b);
  Islands islands(world);
  std::vector<char> restless(world.bodies.size(), 0);
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    const Body& b = world.bodies[i];
    if (b.moves() && b.still < world.settings.rest_window) restless[islands.of(i)] = 1;
  }
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& b = world.bodies[i];
    if (!b.present || b.inverse_mass == 0) continue;
    const bool sleep = !restless[islands.of(i)];
    if (sleep && !b.asleep) {
      b.v.setZero();
      b.w.setZero();
    }
    if (!sleep && b.asleep) b.still = 0;
    b.asleep = sleep;
  }
}

void wake(World& world, std::uint32_t body) {
  Islands islands(world);
  const std::uint32_t island = islands.of(body);
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i)
    if (islands.of(i) == island) {
      world.bodies[i].asleep = false;
      world.bodies[i].still = 0;
    }
}

namespace {

/// A pass, and what it takes added to `ms`.
void timed(void (*pass)(World&), World& world, double& ms) {
  const auto begin = std::chrono::steady_clock::now();
  pass(world);
  ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

void step(World& world) {
  ++world.counters.steps;
  bool any_moves = false;
  for (const Body& b : world.bodies) {
    any_moves |= b.moves();
    world.counters.asleep_steps += b.present && b.asleep;
  }
  if (!any_moves) return;
  Spent& spent = world.spent;
  timed(find_pairs, world, spent.broad_phase);
  timed(find_contacts, world, spent.narrow_phase);
  timed(color_manifolds, world, spent.coloring);
  timed(solve, world, spent.contact_solver);
  timed(update_sleep, world, spent.islands);
  if (world.cold_steps > 0) --world.cold_steps;
  world.forgets = false;
}

}  // namespace bin_scenes::sphere
