/// Puts islands of bodies at rest to sleep, and wakes those that something hits or presses on. GPU form:
/// shaders/sphere/update_sleep.comp and, for what is hit, color_manifolds.comp.
#include "core/disjoint_sets.hpp"

#include "solver/sphere/invariants.hpp"
#include "solver/sphere/passes/contact_gap.hpp"
#include "solver/sphere/world.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

namespace {

/// Whether two bodies press on each other; walls and fixed bodies join nothing.
bool joins(const World& world, const Manifold& m) {
  if (m.b == ground || world.bodies[m.a].inverse_mass == 0 || world.bodies[m.b].inverse_mass == 0) return false;
  return std::any_of(m.contacts.begin(), m.contacts.end(), [](const Contact& c) { return c.normal_force > 0; });
}

/// Bodies joined by pressing contacts.
DisjointSets islands_of(const World& world) {
  DisjointSets islands(world.bodies.size());
  for (const Manifold& m : world.manifolds)
    if (joins(world, m)) islands.join(m.a, m.b);
  return islands;
}

void note_motion(const World& world, Body& b) {
  const Shape& s = *world.shapes[b.shape];
  const float limit = (world.sleep == Sleep::by_touch ? world.settings.touch_move : world.settings.rest_move) * s.size;
  const float turned = 2.0f * (b.still_q.conjugate() * b.q).vec().norm() * s.radius;
  if ((b.x - b.still_x).norm() > limit || turned > limit) {
    b.still = 0;
    b.still_x = b.x;
    b.still_q = b.q;
  } else {
    b.still += world.settings.time_step;
  }
  BIN_SCENES_ASSERT(b.still >= 0);
}

bool moved_recently(const World& world, std::uint32_t body) {
  return world.bodies[body].moves() && world.bodies[body].still < world.settings.rest_window;
}

/// Whether it moved on in this step: bodies that are woken by touch have not, unless they go.
bool went_on(const World& world, std::uint32_t body) {
  return world.bodies[body].moves() && world.bodies[body].still == 0;
}

bool touch(const Manifold& m) {
  return m.b != ground && !m.contacts.empty();
}

/// Whom bodies that moved recently keep awake: themselves and those joined to them, directly if bodies sleep by part.
/// By touch they wake all that have contacts with them as they go on, pressed or not: what carried a part does so no
/// more.
std::vector<char> kept_awake(const World& world) {
  const auto count = static_cast<std::uint32_t>(world.bodies.size());
  std::vector<char> awake(count, 0);
  if (world.sleep != Sleep::by_island) {
    for (std::uint32_t i = 0; i < count; ++i) awake[i] = moved_recently(world, i);
    const bool by_part = world.sleep == Sleep::by_part;
    for (const Manifold& m : world.manifolds)
      if (by_part ? joins(world, m) && (moved_recently(world, m.a) || moved_recently(world, m.b))
                  : touch(m) && (went_on(world, m.a) || went_on(world, m.b)))
        awake[m.a] = awake[m.b] = 1;
    return awake;
  }
  DisjointSets islands = islands_of(world);
  std::vector<char> of_island(count, 0);
  for (std::uint32_t i = 0; i < count; ++i)
    if (moved_recently(world, i)) of_island[islands.root(i)] = 1;
  for (std::uint32_t i = 0; i < count; ++i) awake[i] = of_island[islands.root(i)];
  return awake;
}

/// A gripper wakes what it touches, and keeps it awake.
void keep_held_awake(const World& world, std::vector<char>& awake) {
  if (!world.jaws && world.pulls.empty()) return;
  for (const Manifold& m : world.manifolds)
    if (m.b != ground && !m.contacts.empty() && (world.bodies[m.a].driven || world.bodies[m.b].driven))
      awake[m.a] = awake[m.b] = 1;
  BIN_SCENES_ASSERT(each_is(world.pulls, [&](const Pull& pull) { return pull.body < awake.size(); }));
  for (const Pull& pull : world.pulls) awake[pull.body] = 1;
}

}  // namespace

/// By island: an island of bodies that press on each other sleeps once all of them have stayed where they are for the
/// rest window; a moving body that presses on a sleeping one wakes the whole island.
/// By part (a probe): each body sleeps alone once it has stayed. That is safe since all of them are awake at first.
/// By touch (a repair): a body that moves wakes those it touches. Who is woken sleeps again after a rest window, and
/// wakes others only if it moves itself.
void update_sleep(World& world) {
  for (Body& b : world.bodies)
    if (b.moves()) note_motion(world, b);
  std::vector<char> awake = kept_awake(world);
  keep_held_awake(world, awake);
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& b = world.bodies[i];
    if (!b.present || b.inverse_mass == 0) continue;
    if (!awake[i] && !b.asleep) {
      b.v.setZero();
      b.w.setZero();
    }
    if (awake[i] && b.asleep && world.sleep == Sleep::by_island) b.still = 0;
    if (awake[i] && b.asleep && world.sleep == Sleep::by_touch) b.still = world.settings.time_step;
    b.asleep = !awake[i];
  }
}

/// A sleeping body would be as heavy as a wall to what hits it, until it wakes at the end of the step: the impact would
/// take or return twice the momentum. The last sweeps of a step look ahead by a sub-step, and so does this. Bodies that
/// are slower than those that bounce wake it by pressing. What gravity adds in the step, and rounding, are less than
/// `least`.
void wake_struck(World& world) {
  const float seconds = world.settings.time_step + world.plan().sub_step;
  const float least = seconds * world.settings.restitution_speed;
  std::vector<std::uint32_t> struck;
  for (const Manifold& m : world.manifolds) {
    if (m.b == ground || world.bodies[m.a].asleep == world.bodies[m.b].asleep) continue;
    if (strikes(world, m, seconds, least, least)) struck.push_back(world.bodies[m.a].asleep ? m.a : m.b);
  }
  if (struck.empty()) return;
  DisjointSets islands =
      world.sleep == Sleep::by_island ? islands_of(world) : DisjointSets(world.bodies.size());  // else each alone
  std::vector<char> wakes(world.bodies.size(), 0);
  for (const std::uint32_t i : struck) wakes[islands.root(i)] = 1;
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& body = world.bodies[i];
    if (!body.asleep || !wakes[islands.root(i)]) continue;
    body.asleep = false;
    body.still = world.settings.time_step;  // it does not fall
  }
}

std::vector<std::uint32_t> touched_by(const World& world, std::uint32_t body) {
  std::vector<std::uint32_t> touched;
  for (const Manifold& m : world.manifolds)
    if ((m.a == body || m.b == body) && touch(m)) {
      const std::uint32_t other = m.a == body ? m.b : m.a;
      if (world.bodies[other].inverse_mass > 0) touched.push_back(other);
    }
  return touched;
}

void wake(Body& body) {
  body.asleep = false;
  body.still = 0;
}

void put_to_sleep(const Settings& settings, Body& body) {
  if (!body.present || body.inverse_mass == 0) return;
  body.v.setZero();
  body.w.setZero();
  body.asleep = true;
  body.still = settings.rest_window;
  body.still_x = body.x;
  body.still_q = body.q;
}

}  // namespace bin_scenes::sphere
